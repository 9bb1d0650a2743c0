// voqcal_figures field: what becomes of recordings that other people made, one folder each.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calibrate/collect.hpp"
#include "common/scratch_folder.hpp"
#include "core/estimation/pose_fit.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "figures/figures.hpp"
#include "import/acfr_session.hpp"

namespace voqcal {
namespace {

struct FieldArgs {
  std::filesystem::path data;
  std::string only;  // one set's name; empty: all
  bool is_verbose = false;
};

// Of six dimensions, as rare as 3 sigma of one: 0.27 %.
constexpr double kSquared3Sigma = 20.06;

// The folders of `data` that have a rig file, by name.
std::vector<std::filesystem::path> SetsIn(const FieldArgs& args) {
  std::vector<std::filesystem::path> sets;
  for (const auto& entry : std::filesystem::directory_iterator(args.data)) {
    if (!std::filesystem::exists(entry.path() / "rig.yaml")) continue;
    if (args.only.empty() || entry.path().filename() == args.only) sets.push_back(entry.path());
  }
  std::sort(sets.begin(), sets.end());
  return sets;
}

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

// The samples whose board lies farther from where the others' extrinsic puts it than 3 sigma of
// both covariances allow.
std::vector<std::int64_t> WrongOnes(const std::vector<const BoardSample*>& samples,
                                    const Rig& rig,
                                    bool is_verbose) {
  std::vector<std::int64_t> wrong;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<const BoardSample*> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const PoseFit fit = FitPoses(others, rig.camera, AnalyticExtrinsic(others), {});
    if (!fit.is_usable) continue;
    PoseDifference difference = DifferenceOf(*samples[i], rig.camera, fit.T_camera_lidar, {});
    difference.C += difference.J * fit.covariance * difference.J.transpose();
    const double squared = difference.SquaredSigmas();
    if (squared > kSquared3Sigma) wrong.push_back(samples[i]->id);
    if (!is_verbose) continue;
    const Vector6d& r = difference.r;
    const Vector6d sigma = difference.C.diagonal().cwiseSqrt();
    std::printf("  sample %3lld  sides %d  off by %4.1f sigma",
                static_cast<long long>(samples[i]->id),
                NumMeasuredSides(samples[i]->lidar),
                std::sqrt(squared));
    std::printf("  deg %5.2f %5.2f %5.2f (%.2f %.2f %.2f)",
                180 / M_PI * r[0],
                180 / M_PI * r[1],
                180 / M_PI * r[2],
                180 / M_PI * sigma[0],
                180 / M_PI * sigma[1],
                180 / M_PI * sigma[2]);
    std::printf("  mm %6.1f %6.1f %6.1f (%.1f %.1f %.1f)\n",
                1e3 * r[3],
                1e3 * r[4],
                1e3 * r[5],
                1e3 * sigma[3],
                1e3 * sigma[4],
                1e3 * sigma[5]);
  }
  return wrong;
}

std::string HeldOutCentre(const OfflineRun& run) {
  const auto& result = run.assessor().result();
  if (!result) return "- (" + run.assessor().problem() + ")";
  if (!std::isfinite(result->held_out.centre_mm.mean)) return "-";
  char text[64];
  std::snprintf(text,
                sizeof(text),
                "%.2f +- %.2f",
                result->held_out.centre_mm.mean,
                result->held_out.centre_mm.std);
  return text;
}

void PrintSet(const std::filesystem::path& set, const FieldArgs& args) {
  const Rig rig = LoadRig(set / "rig.yaml");
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-field");
  const std::filesystem::path log = scratch.path() / "raw.lcm";
  const ImportedFrames frames = ImportAcfrSession(set, rig, 2.0, log);
  const std::filesystem::path session = scratch.path() / "session";
  std::filesystem::create_directories(session);
  InputPaths input;
  input.log = log;
  const auto run = CollectSamples(rig, input, session);
  run->Finish(/*is_collecting_only=*/false);
  const std::vector<BoardSample> all = run->SamplesAsChosen();
  const auto samples = SamplesWithout(all, run->averaged().inconsistent_ids);
  const auto wrong = WrongOnes(samples, rig, args.is_verbose);
  std::printf("%-26s %5zu  %6zu  %5zu  %7zu  %10zu  %5zu  %s\n",
              set.filename().c_str(),
              frames.num_clouds,
              CountIn(*run, "camera_board_detector", "boards"),
              CountIn(*run, "lidar_board_detector", "boards"),
              all.size(),
              samples.size(),
              wrong.size(),
              HeldOutCentre(*run).c_str());
  if (args.is_verbose) std::printf("  %s\n", CountsOf(*run).c_str());
}

void PrintField(const FieldArgs& args) {
  std::puts(
      "set                        pairs  camera  lidar  samples  consistent  wrong  held-out "
      "centre mm");
  for (const std::filesystem::path& set : SetsIn(args)) {
    try {
      PrintSet(set, args);
    } catch (const std::exception& error) {
      std::printf("%-26s %s\n", set.filename().c_str(), error.what());
    }
  }
}

}  // namespace

void AddField(CLI::App* app) {
  const auto args = std::make_shared<FieldArgs>();
  CLI::App* figure = app->add_subcommand(
      "field", "Recordings of other people: which boards become samples, and whether any is wrong");
  figure
      ->add_option("--data",
                   args->data,
                   "Folder of sets: each has rig.yaml, images/poseN.png and pcd/poseN_full.pcd")
      ->required()
      ->check(CLI::ExistingDirectory);
  figure->add_option("--only", args->only, "The name of one set");
  figure->add_flag("--verbose", args->is_verbose, "Each sample's difference from the others");
  figure->callback([args] { PrintField(*args); });
}

}  // namespace voqcal
