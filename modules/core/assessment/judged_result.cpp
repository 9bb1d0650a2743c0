#include "core/assessment/judged_result.hpp"

#include <array>
#include <cmath>

#include "core/assessment/predicted_error.hpp"
#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kSigmas95 = 1.959964;

}  // namespace

double IntervalsOf(const Vector6d& move, const Matrix6d& covariance) {
  const Vector6d interval = kSigmas95 * covariance.diagonal().cwiseSqrt();
  return move.cwiseAbs().cwiseQuotient(interval).maxCoeff<Eigen::PropagateNaN>();
}

std::string MoveText(const Vector6d& move, const Matrix6d& covariance) {
  return Format(
      "it moves the result by %.2f deg and %.0f mm, %.1f times its 95 %% interval with this rig "
      "file",
      kDegPerRad * move.head<3>().norm(),
      kMmPerM * move.tail<3>().norm(),
      IntervalsOf(move, covariance));
}

Landing LandingOf(const CameraModel& camera, const Vector6d& move, const JudgedResult& result) {
  constexpr std::array<double, 4> kRangesM = {2, 5, 10, 20};
  constexpr std::array<double, 3> kShares = {1.0 / 6, 0.5, 5.0 / 6};  // of the image's sides
  const Eigen::Isometry3d moved =
      PerturbLeft(result.T_camera_lidar, move) * result.T_camera_lidar.inverse();
  double sum_px2 = 0;
  double sum_variance_px2 = 0;
  int num = 0;
  for (const double x : kShares) {
    for (const double y : kShares) {
      const Eigen::Vector2d lands_px(x * result.camera.width_px, y * result.camera.height_px);
      const auto ray = result.camera.Unproject(lands_px);
      if (!ray) continue;
      for (const double range_m : kRangesM) {
        const Eigen::Vector3d point_camera_m = range_m * *ray;
        const PointErrorForms forms =
            ErrorFormsAt(point_camera_m, result.T_camera_lidar, result.camera);
        sum_px2 += (camera.Project(moved * point_camera_m) - lands_px).squaredNorm();
        sum_variance_px2 += (forms.px2 * result.covariance).trace();
        ++num;
      }
    }
  }
  if (num == 0) return {HUGE_VAL, HUGE_VAL};
  return {std::sqrt(sum_px2 / num), std::sqrt(sum_px2 / sum_variance_px2) / kSigmas95};
}

}  // namespace voqcal
