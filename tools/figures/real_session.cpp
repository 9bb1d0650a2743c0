#include "figures/real_session.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/scratch_folder.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/session_scenes.hpp"

namespace voqcal {

std::vector<SessionPose> LoadSession(const Rig& rig, const InputPaths& input) {
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-session");
  const auto run = CollectSamples(rig, input, scratch.path());
  run->Finish(/*is_collecting_only=*/true);
  std::vector<SessionPose> poses;
  std::map<std::int64_t, std::size_t> pose_of;
  const ChosenSamples chosen = ChooseSamples(run->samples(), rig.camera, rig.consistency);
  for (const BoardSample* sample : chosen.Used()) {
    pose_of[sample->id] = poses.size();
    poses.push_back({*sample, std::nullopt, std::nullopt});
  }
  SessionSceneReader reader(scratch.path() / kSamplesLogName);
  while (const std::optional<SessionScene> scene = reader.Next()) {
    const auto found = pose_of.find(scene->sample_id);
    if (found == pose_of.end()) continue;
    SessionPose& pose = poses[found->second];
    const PointCloud cloud = FromMessage(scene->sweep);
    const cv::Mat image = FromMessage(scene->image);
    pose.view =
        MakeSceneView(cloud, image, pose.sample, rig.board, rig.camera, rig.scene_check.view);
    pose.judged = MakeJudgedScene(cloud, image, pose.sample, rig.board);
  }
  return poses;
}

SessionPoses Shuffled(const std::vector<SessionPose>& poses, std::uint32_t seed, int number) {
  const KeyedNoise noise(seed, NoiseUse::kStops, number);
  std::vector<std::pair<std::uint64_t, const SessionPose*>> order;
  for (std::size_t i = 0; i < poses.size(); ++i) order.emplace_back(noise.Bits(i), &poses[i]);
  std::sort(order.begin(), order.end());
  SessionPoses shuffled;
  for (const auto& [_, pose] : order) shuffled.push_back(pose);
  return shuffled;
}

std::vector<BoardSample> SamplesOf(const SessionPoses& poses) {
  std::vector<BoardSample> samples;
  for (const SessionPose* pose : poses) samples.push_back(pose->sample);
  return samples;
}

std::vector<JudgedScene> JudgedScenesOf(const SessionPoses& poses) {
  std::vector<JudgedScene> scenes;
  for (const SessionPose* pose : poses) {
    if (pose->judged) scenes.push_back(*pose->judged);
  }
  return scenes;
}

SceneViewsOf ViewsOf(const SessionPoses& poses) {
  return [poses](const std::vector<const BoardSample*>& samples) {
    std::vector<SceneView> views;
    for (const BoardSample* sample : samples) {
      for (const SessionPose* pose : poses) {
        if (pose->sample.id == sample->id && pose->view) views.push_back(*pose->view);
      }
    }
    return views;
  };
}

CalibrationOutcome CalibratePoses(const SessionPoses& poses, const CalibrationTask& task) {
  return Calibrate(SamplesOf(poses), ViewsOf(poses), task);
}

}  // namespace voqcal
