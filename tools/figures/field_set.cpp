#include "figures/field_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/collect.hpp"
#include "common/scratch_folder.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/estimation/variance_components.hpp"
#include "import/acfr_session.hpp"

namespace voqcal {
namespace {

std::size_t CountIn(const OfflineRun& run,
                    const std::string& module_name,
                    const std::string& what) {
  for (const Module* module : run.modules()) {
    if (module->Name() != module_name) continue;
    const auto found = module->counters().find(what);
    return found == module->counters().end() ? 0 : static_cast<std::size_t>(found->second);
  }
  return 0;
}

}  // namespace

std::size_t FieldSet::NumWrong() const {
  return static_cast<std::size_t>(
      std::count_if(differences.begin(), differences.end(), [](const SampleDifference& d) {
        return d.IsWrong();
      }));
}

FieldSet MeasureFieldSet(const std::filesystem::path& folder) {
  constexpr double kRateHz = 2.0;  // any: pairs have the same times
  const Rig rig = LoadRig(folder / "rig.yaml");
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-field");
  InputPaths input;
  input.log = scratch.path() / "raw.lcm";
  FieldSet set;
  set.name = folder.filename().string();
  set.num_pairs = ImportAcfrSession(folder, rig, {kRateHz, false}, *input.log).num_clouds;
  const std::filesystem::path session = scratch.path() / "session";
  std::filesystem::create_directories(session);
  const auto run = CollectSamples(rig, input, session);
  run->Finish(/*is_collecting_only=*/false);

  const std::vector<BoardSample> all = run->SamplesAsChosen();
  const auto consistent = SamplesWithout(all, run->averaged().inconsistent_ids);
  set.num_camera_boards = CountIn(*run, "camera_board_detector", "boards");
  set.num_lidar_boards = CountIn(*run, "lidar_board_detector", "boards");
  set.num_samples = all.size();
  set.num_consistent = consistent.size();
  set.differences = DifferencesFromOthers(consistent, rig.camera);
  if (!consistent.empty()) {
    set.errors = FitWithErrors(consistent, rig.camera, AnalyticExtrinsic(consistent)).errors;
  }
  const auto& result = run->assessor().result();
  set.held_out_mm = result ? result->held_out.centre_mm.mean : std::nan("");
  set.problem = run->assessor().problem();
  set.counts = CountsOf(*run);
  return set;
}

}  // namespace voqcal
