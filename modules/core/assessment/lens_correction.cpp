#include "core/assessment/lens_correction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/camera/lens_errors.hpp"
#include "core/estimation/lens_terms.hpp"

namespace voqcal {
namespace {

SceneScore HeldOut(const std::vector<const BoardSample*>& samples,
                   const BoardSpec& board,
                   const CameraModel& camera,
                   const LikelihoodExtrinsic& all,
                   const LikelihoodOptions& options) {
  std::vector<PoseScore> poses(samples.size());
  for (std::size_t left_out = 0; left_out < samples.size(); ++left_out) {
    std::vector<const BoardSample*> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const LikelihoodExtrinsic refined = RefineWithLensNearby(others, board, camera, all, options);
    if (!refined.IsUsable()) continue;
    const BoardSample& sample = *samples[left_out];
    BoardSample corrected = CorrectedSample(sample, refined.bias);
    corrected.camera.pose = CorrectedCameraPose(sample, board, camera, refined.lens.errors);
    poses[left_out] =
        ScorePose(corrected, CorrectedCamera(camera, refined.lens.errors), refined.T_camera_lidar);
  }
  return SummariseScores(std::move(poses));
}

// Share by which the held-out error must fall: less is no reason to touch intrinsics, and chance
// gives some.
constexpr double kMinGain = 0.1;

double ErrorMm(const SceneScore& held_out) {
  return MethodTrial{RefineMethod::kLikelihood, "", held_out}.ErrorMm();
}

bool HavePointsAndPixels(const std::vector<const BoardSample*>& samples) {
  return std::all_of(samples.begin(), samples.end(), [](const BoardSample* sample) {
    return !sample->lidar.points_lidar_m.points.empty() && !sample->camera.corners_px.empty();
  });
}

}  // namespace

LensCorrection CorrectLens(const std::vector<const BoardSample*>& samples,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const SceneScore& held_out_without,
                           const LikelihoodOptions& options) {
  LensCorrection correction;
  correction.camera = camera;
  if (!HavePointsAndPixels(samples)) {
    correction.problem = "samples without the lidar's points or the chessboard's pixels";
    return correction;
  }
  const LikelihoodExtrinsic refined =
      RefineWithLens(samples, board, camera, T_camera_lidar, options);
  if (!refined.IsUsable()) {
    correction.problem = "the refinement is " + ToString(refined.status);
    return correction;
  }
  correction.errors = refined.lens;
  if (!refined.lens.IsObservable()) {
    correction.problem = "the samples do not tell it";
    return correction;
  }
  correction.camera = CorrectedCamera(camera, refined.lens.errors);
  correction.T_camera_lidar = refined.T_camera_lidar;
  correction.covariance = refined.uncertainty.covariance;
  correction.held_out = HeldOut(samples, board, camera, refined, options);
  const double with_mm = ErrorMm(correction.held_out);
  const double without_mm = ErrorMm(held_out_without);
  correction.problem.clear();
  if (!std::isfinite(with_mm) || !std::isfinite(without_mm)) {
    correction.problem = "not every pose could be held out";
  } else if (with_mm >= (1.0 - kMinGain) * without_mm) {
    correction.problem = "poses held out fit hardly better with it";
  }
  return correction;
}

}  // namespace voqcal
