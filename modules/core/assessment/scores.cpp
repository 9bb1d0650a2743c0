#include "core/assessment/scores.hpp"

#include <algorithm>
#include <cmath>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/geometry/rigid.hpp"
#include "core/parallel.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

double MeanCornerDistanceM(const BoardPose& pose_lidar,
                           const BoardPose& pose_camera,
                           const Eigen::Isometry3d& T_camera_lidar) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum_m += (T_camera_lidar * pose_lidar.corners_m[i] - pose_camera.corners_m[i]).norm();
  }
  return sum_m / 4.0;
}

// Of a board whose centre the lidar did not measure, only the normal is scored: such a pose counts
// where it can. One without any score leaves the scene without one.
Spread SpreadOf(const std::vector<PoseScore>& all, double PoseScore::*figure) {
  std::vector<PoseScore> poses;
  for (const PoseScore& pose : all) {
    if (std::isnan(pose.*figure) && std::isfinite(pose.normal_deg)) continue;
    poses.push_back(pose);
  }
  Spread spread;
  if (poses.empty()) return spread;
  const double num_poses = static_cast<double>(poses.size());
  double sum = 0.0;
  for (const PoseScore& pose : poses) sum += pose.*figure;
  spread.mean = sum / num_poses;
  if (!std::isfinite(spread.mean)) return {};
  double sum_of_squares = 0.0;
  spread.max = 0.0;
  for (const PoseScore& pose : poses) {
    sum_of_squares += (pose.*figure - spread.mean) * (pose.*figure - spread.mean);
    spread.max = std::max(spread.max, pose.*figure);
  }
  spread.std = std::sqrt(sum_of_squares / num_poses);
  return spread;
}

}  // namespace

SceneScore SummariseScores(std::vector<PoseScore> poses) {
  SceneScore scene;
  scene.centre_px = SpreadOf(poses, &PoseScore::centre_px);
  scene.centre_mm = SpreadOf(poses, &PoseScore::centre_mm);
  scene.corner_mm = SpreadOf(poses, &PoseScore::corner_mm);
  scene.normal_deg = SpreadOf(poses, &PoseScore::normal_deg);
  scene.poses = std::move(poses);
  return scene;
}

PoseScore ScorePose(const BoardSample& sample,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar) {
  const BoardPose& seen = sample.camera.pose;
  const BoardPose lidar = LidarPoseInCameraOrder(sample, T_camera_lidar);
  const Eigen::Vector3d centre_camera_m = T_camera_lidar * lidar.centre_m;
  if (!camera.IsInFront(centre_camera_m) || !camera.IsInFront(seen.centre_m)) return {};
  PoseScore score;
  score.normal_deg = kDegPerRad * AngleBetween(T_camera_lidar.linear() * lidar.normal, seen.normal);
  if (!IsCentreMeasured(sample.lidar)) return score;
  score.centre_px = (camera.Project(centre_camera_m) - camera.Project(seen.centre_m)).norm();
  score.centre_mm = kMmPerM * MetresPerPixel(seen, camera) * score.centre_px;
  score.corner_mm = kMmPerM * MeanCornerDistanceM(lidar, seen, T_camera_lidar);
  return score;
}

SceneScore ScoreScene(const std::vector<const BoardSample*>& samples,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<PoseScore> poses;
  for (const BoardSample* sample : samples) {
    poses.push_back(ScorePose(*sample, camera, T_camera_lidar));
  }
  return SummariseScores(std::move(poses));
}

double CombinedErrorMm(const SceneScore& scene) {
  return std::sqrt(scene.centre_mm.mean * scene.corner_mm.mean);
}

SceneScore ScoreHeldOut(const std::vector<const BoardSample*>& samples,
                        const ScoreByOthers& score) {
  std::vector<PoseScore> poses(samples.size());
  ParallelFor(samples.size(), [&](std::size_t i) {
    std::vector<const BoardSample*> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    poses[i] = score(*samples[i], others);
  });
  return SummariseScores(std::move(poses));
}

SceneScore LeaveOneOutScore(const std::vector<const BoardSample*>& samples,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar_start,
                            const RefineOptions& options) {
  return ScoreHeldOut(samples, [&](const BoardSample& held_out, const auto& others) -> PoseScore {
    const RefinedExtrinsic refined = RefineExtrinsic(others, camera, T_camera_lidar_start, options);
    if (!refined.IsUsable()) return {};
    return ScorePose(held_out, camera, refined.T_camera_lidar);
  });
}

}  // namespace voqcal
