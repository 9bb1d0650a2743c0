#include "core/assessment/lens_correction.hpp"

#include <algorithm>
#include <cmath>

#include "core/camera/lens_errors.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/camera_faults.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

SceneScore HeldOut(const std::vector<const BoardSample*>& samples,
                   const BoardSpec& board,
                   const CameraModel& camera,
                   const LikelihoodExtrinsic& all,
                   const LikelihoodOptions& options) {
  return ScoreHeldOut(samples, [&](const BoardSample& held_out, const auto& others) -> PoseScore {
    const LikelihoodExtrinsic refined = RefineWithLensNearby(others, board, camera, all, options);
    if (!refined.IsUsable()) return {};
    BoardSample corrected = CorrectedSample(held_out, refined.bias, Eigen::Vector2d::Zero());
    corrected.camera.pose = CorrectedCameraPose(held_out, board, camera, refined.lens.errors);
    return ScorePose(
        corrected, CorrectedCamera(camera, refined.lens.errors), refined.T_camera_lidar);
  });
}

// Share by which the held-out error must fall: less is no reason to touch intrinsics, and chance
// gives some.
constexpr double kMinGain = 0.1;

bool HavePointsAndPixels(const std::vector<const BoardSample*>& samples) {
  return std::all_of(samples.begin(), samples.end(), [](const BoardSample* sample) {
    return !sample->lidar.points_lidar_m.points.empty() && !sample->camera.corners_px.empty();
  });
}

/// Whether each corner of the image that had a ray still has one: a lens fitted to boards in the
/// middle may fold over before.
bool ReachesAsFar(const CameraModel& corrected, const CameraModel& given) {
  for (const double x_px : {0.0, given.width_px - 1.0}) {
    for (const double y_px : {0.0, given.height_px - 1.0}) {
      if (given.Unproject({x_px, y_px}) && !corrected.Unproject({x_px, y_px})) return false;
    }
  }
  return true;
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
  const CameraModel corrected = CorrectedCamera(camera, refined.lens.errors);
  if (!corrected.Problems().empty()) {
    correction.problem = "the corrected camera's " + corrected.Problems().front();
    return correction;
  }
  if (!ReachesAsFar(corrected, camera)) {
    correction.problem = "the corrected lens does not reach the image's corners";
    return correction;
  }
  correction.camera = corrected;
  correction.T_camera_lidar = refined.T_camera_lidar;
  correction.covariance = refined.uncertainty.covariance;
  correction.held_out = HeldOut(samples, board, camera, refined, options);
  const double with_mm = CombinedErrorMm(correction.held_out);
  const double without_mm = CombinedErrorMm(held_out_without);
  correction.problem.clear();
  if (!std::isfinite(with_mm) || !std::isfinite(without_mm)) {
    correction.problem = "not every pose could be held out";
  } else if (with_mm >= (1.0 - kMinGain) * without_mm) {
    correction.problem = "poses held out fit hardly better with it";
  }
  return correction;
}

std::string OtherLens(const LensCorrection& correction, const SceneScore& held_out) {
  if (!correction.IsUsable()) return "";
  const LensErrors& errors = correction.errors.errors;
  const double reach_px = LensReachPx(correction.camera);
  return Format(
      "the samples ask for another lens: focal length %+.2f %%, principal point %+.1f %+.1f px. "
      "Corners of boards held out err by %.1f mm with it, by %.1f mm with the rig file's",
      100 * errors[kFocalLength],
      reach_px * errors[kPrincipalPointX],
      reach_px * errors[kPrincipalPointY],
      correction.held_out.corner_mm.mean,
      held_out.corner_mm.mean);
}

std::string WhichToTake(const LensCorrection& correction, const Eigen::Isometry3d& T_camera_lidar) {
  if (!correction.IsUsable()) return "";
  const Vector6d move = DifferenceLeft(T_camera_lidar, correction.T_camera_lidar);
  return Format(
      "Take T_camera_lidar with the intrinsics of the rig file, wherever these are used. Take "
      "lens_correction's only together with its camera, everywhere: it is turned by %.2f deg and "
      "shifted by %.1f mm, and either with the other's intrinsics is off by as much.",
      kDegPerRad * move.head<3>().norm(),
      kMmPerM * move.tail<3>().norm());
}

}  // namespace voqcal
