// voq_study: the experiments of Tsai et al. 2021 on any data, and how well each selector does.

#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>

#include "calibrate/collect.hpp"
#include "common/run_program.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "core/selection/consistency.hpp"
#include "rig/rig.hpp"
#include "study/study_files.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kLeastSamples = 5;  // leave-one-out needs sets, and poses beyond each set
constexpr int kNumBins = 40;

struct StudyArgs {
  std::filesystem::path rig;
  InputPaths input;
  std::filesystem::path out;
  bool has_plots = true;
};

// The samples that hold together. What was left out is said.
std::vector<BoardSample> ReadSamples(const Rig& rig, const InputPaths& input) {
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-study");
  const auto run = CollectSamples(rig, input, scratch.path());
  run->Finish(/*is_collecting_only=*/true);
  const Consistency consistency = FindConsistent(run->samples(), rig.consistency);
  for (const InconsistentSample& each : consistency.inconsistent) {
    spdlog::info("left out sample {}: {}",
                 run->samples()[static_cast<std::size_t>(each.sample)].id,
                 each.reason);
  }
  std::vector<BoardSample> samples = ConsistentSamples(run->samples(), consistency);
  if (samples.size() < kLeastSamples) {
    throw std::runtime_error(input.Given().string() + ": " + std::to_string(samples.size()) +
                             " samples that agree with each other; a study needs " +
                             std::to_string(kLeastSamples));
  }
  return samples;
}

Study MakeStudy(const std::vector<BoardSample>& samples, const Rig& rig) {
  constexpr double kAnyKappa = std::numeric_limits<double>::infinity();
  constexpr double kMaxKappaOfBoardError = 20.0;  // the paper's, section IV-C
  Study study;
  for (const BoardSample& sample : samples) study.sample_ids.push_back(sample.id);
  study.sets = StudyAllSets(samples, rig.board, rig.camera, rig.extrinsic_estimator);
  study.experiments = {
      {"condition_number", BinSets(study.sets, &StudiedSet::kappa, kAnyKappa, kNumBins)},
      {"board_error",
       BinSets(study.sets, &StudiedSet::board_error_mm, kMaxKappaOfBoardError, kNumBins)},
      {"voq", BinSets(study.sets, &StudiedSet::voq, kAnyKappa, kNumBins)}};
  study.correlations = RankCorrelations(study.sets);
  for (const SelectionCriterion criterion : AllSelectionCriteria()) {
    study.selectors.push_back(CrossValidate(samples, rig, criterion));
  }
  return study;
}

void Print(const Study& study) {
  std::printf("%zu samples, %zu sets of three\n\n", study.sample_ids.size(), study.sets.size());
  std::puts("rank correlation (Spearman) with a set's held-out centre error");
  for (const RankCorrelation& each : study.correlations) {
    std::printf("  %-18s %+.2f\n", each.figure.c_str(), each.spearman);
  }
  std::puts("\nheld-out centre error, mm: mean +- deviation (largest)");
  std::puts("  criterion           average of its sets        refined from that average");
  for (const SelectorScore& each : study.selectors) {
    std::printf("  %-18s %6.2f +- %5.2f (%6.2f)   %6.2f +- %5.2f (%6.2f)\n",
                each.name.c_str(),
                each.average_mm.mean,
                each.average_mm.std,
                each.average_mm.max,
                each.final_mm.mean,
                each.final_mm.std,
                each.final_mm.max);
  }
}

void RunStudy(const StudyArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const std::vector<BoardSample> samples = ReadSamples(rig, args.input);
  std::filesystem::create_directories(args.out);
  const Study study = MakeStudy(samples, rig);
  WriteStudy(study, args.out);
  Print(study);
  if (!args.has_plots) return;
  const std::string problem = RunProgram({ScriptOfTools("study/plot_study.py"), args.out.string()});
  if (!problem.empty()) throw std::runtime_error("tables but no plots: " + problem);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Studies which sets of poses calibrate well: every combination of three is calibrated "
      "and scored on the others.",
      "voq_study");
  voqcal::StudyArgs args;
  app.add_option("--rig", args.rig, "The rig file (YAML)")->required();
  auto* input = app.add_option_group("input", "One of:");
  input->add_option("--log", args.input.log, "A recording (LCM log), or a session's samples.lcm");
  input->add_option(
      "--poses", args.input.poses, "Extracted features: poses.csv of cam_lidar_calibration");
  input->require_option(1);
  app.add_option("--out", args.out, "Folder for the tables and plots; made if missing")->required();
  app.add_flag("!--no-plots", args.has_plots, "Only the tables");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::RunStudy(args); });
}
