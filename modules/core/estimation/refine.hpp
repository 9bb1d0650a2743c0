#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/refine_status.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// Minimised: sum of weight * huber(|pixel error|^2) over the centre and the four outline corners
/// of each pose. The centre is the lidar's best measured point (the errors of opposite edges
/// cancel); the corners keep the problem determined where poses are few or close together.
struct RefineOptions {
  double centre_weight = 1.0;   ///< Weight of the centre's squared reprojection error; positive.
  double corner_weight = 0.05;  ///< Weight of each outline corner's; 0 leaves them out.
  double huber_px = 3.0;        ///< Residuals beyond this count linearly.
  /// 1 sigma of an offset common to all ranges, which the residuals do not show.
  double range_offset_m = 0.03;
  int max_iterations = 100;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The refined extrinsic and what is needed to judge it.
struct RefinedExtrinsic {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera side).
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  double reprojection_rms_px = std::numeric_limits<double>::quiet_NaN();  ///< Of the centres.
  RefineStatus status = RefineStatus::kNotConverged;

  bool IsUsable() const { return status == RefineStatus::kConverged; }
  std::string Summary() const;  ///< One line for a log.
};

/// Refines `T_camera_lidar_start` over every pose: robust reprojection of each pose's lidar centre
/// and corners against the camera's. Corners are matched up to the board's half-turn by the start.
///
/// kDegenerate: fewer than three samples, or parameters that the poses leave open. kNotConverged: a
/// point of a board out of the camera's sight at the start or the end, or out of iterations; the
/// transform is then the start. The covariance is measured by the residuals themselves, correlated
/// within a pose; wider the fewer they are; and holds what a common range offset would move, which
/// they do not show. With hardly more centres than parameters (four poses or fewer) it is NaN.
/// @throws std::invalid_argument if `options` has Problems().
RefinedExtrinsic RefineExtrinsic(const std::vector<const BoardSample*>& samples,
                                 const CameraModel& camera,
                                 const Eigen::Isometry3d& T_camera_lidar_start,
                                 const RefineOptions& options);

}  // namespace voqcal
