// evaluate: scores an extrinsic on poses that it never saw.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "calibrate/advice.hpp"
#include "calibrate/collect.hpp"
#include "calibrate/lens_of_result.hpp"
#include "calibrate/summary.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "core/assessment/best_extrinsic.hpp"
#include "core/format.hpp"
#include "core/selection/consistency.hpp"
#include "files/atomic_file.hpp"
#include "files/sha256.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct EvaluateArgs {
  std::filesystem::path rig;
  InputPaths input;
  std::filesystem::path extrinsic;
};

// "-" for what cannot be told: an edge that was not measured, a centre behind the camera.
std::string Column(double value, int width, int decimals) {
  return std::isnan(value) ? Format("%*s", width, "-") : Format("%*.*f", width, decimals, value);
}

void PrintPoses(const std::vector<const BoardSample*>& samples, const SceneScore& score) {
  std::puts("sample  centre_px  centre_mm  corner_mm  normal_deg");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PoseScore& pose = score.poses[i];
    std::printf("%6lld  %s  %s  %s  %s\n",
                static_cast<long long>(samples[i]->id),
                Column(pose.centre_px, 9, 2).c_str(),
                Column(pose.centre_mm, 9, 2).c_str(),
                Column(pose.corner_mm, 9, 2).c_str(),
                Column(pose.normal_deg, 10, 3).c_str());
  }
}

bool IsInImage(const BoardSample& sample,
               const CameraModel& camera,
               const Eigen::Isometry3d& T_camera_lidar) {
  const Eigen::Vector3d centre_camera_m = T_camera_lidar * sample.lidar.pose.centre_m;
  return camera.IsInFront(centre_camera_m) && camera.Contains(camera.Project(centre_camera_m));
}

/// The camera saw every board: a transform that puts most elsewhere is another one.
void RequireBoardsInImage(const std::vector<const BoardSample*>& samples,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_lidar,
                          const std::filesystem::path& file) {
  const auto num_inside =
      std::count_if(samples.begin(), samples.end(), [&](const BoardSample* sample) {
        return IsInImage(*sample, camera, T_camera_lidar);
      });
  const auto num_outside = static_cast<std::ptrdiff_t>(samples.size()) - num_inside;
  if (num_outside <= num_inside) return;
  throw std::runtime_error(file.string() + ": by it " + std::to_string(num_outside) + " of " +
                           std::to_string(samples.size()) +
                           " boards are behind the camera or outside its image: is it the inverse, "
                           "or another rig's? T_camera_lidar takes lidar coordinates to the "
                           "camera's");
}

/// Whether the file says that it was made from these very samples.
bool IsMadeFrom(const std::filesystem::path& samples_log, const std::filesystem::path& extrinsic) {
  const std::string text = ReadWholeFile(extrinsic);
  if (text.find("made_from:") == std::string::npos) return false;  // another program's
  return LogSha256Of(text, extrinsic.string()) == Sha256OfFile(samples_log);
}

void Evaluate(const EvaluateArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.extrinsic);
  const std::string lens_doubt = LensDoubt(args.extrinsic, rig.camera);
  if (!lens_doubt.empty()) spdlog::warn("{}", lens_doubt);
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-evaluate");
  const auto run = CollectSamples(rig, args.input, scratch.path());
  run->Finish(/*is_collecting_only=*/true);
  if (run->samples().empty()) {
    throw std::runtime_error(args.input.Given().string() + ": no sample to score" +
                             FailureAdvice(*run) + CountsLine(*run));
  }
  const Consistency consistency = FindConsistent(run->samples(), rig.consistency);
  const std::vector<BoardSample> consistent = ConsistentSamples(run->samples(), consistency);
  const std::vector<const BoardSample*> samples = SamplesWithout(consistent, {});
  RequireBoardsInImage(samples, rig.camera, T_camera_lidar, args.extrinsic);
  const LidarBias bias = ReadLidarBias(args.extrinsic);
  const SceneScore score =
      ScoreCorrected(samples, rig.camera, T_camera_lidar, bias, ReadChessboardTurn(args.extrinsic));
  PrintPoses(samples, score);
  for (const InconsistentSample& each : consistency.inconsistent) {
    std::printf("%6lld  left out: %s\n",
                static_cast<long long>(run->samples()[static_cast<std::size_t>(each.sample)].id),
                each.reason.c_str());
  }
  std::printf("%zu samples: %s\n", samples.size(), Summary(score).c_str());
  if (IsMadeFrom(scratch.path() / kSamplesLogName, ResultFileAt(args.extrinsic))) {
    std::puts(
        "these are the samples that the result was made from: its errors on others are larger");
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Scores an extrinsic on the board poses of a recording.", "evaluate");
  voqcal::EvaluateArgs args;
  app.add_option("--rig", args.rig, "The rig file (YAML)")->required();
  auto* input = app.add_option_group("input", "One of:");
  input->add_option("--log", args.input.log, "A recording (LCM log), or a session's samples.lcm");
  input->add_option(
      "--poses", args.input.poses, "Extracted features: poses.csv of cam_lidar_calibration");
  input->require_option(1);
  app.add_option("--extrinsic",
                 args.extrinsic,
                 "A result's folder or its extrinsic.yaml, or any YAML with T_camera_lidar")
      ->required();
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Evaluate(args); });
}
