#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <ceres/sized_cost_function.h>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/refine.hpp"

namespace voqcal {

/// Pixel error of one point of the board:
///     r = B (project(R p_lidar + t) - u)          r: 2, pixels
/// B: how far the point is to be trusted (PointTrust).
/// Parameters: delta, 6, of (R, t) = PerturbLeft(T_start, delta), [rotation_rad; translation_m].
class PointReprojectionCost final : public ceres::SizedCostFunction<2, 6> {
 public:
  PointReprojectionCost(const CameraModel& camera,
                        const Eigen::Isometry3d& T_camera_lidar_start,
                        const Eigen::Vector3d& point_lidar_m,
                        const Eigen::Vector2d& point_px,
                        const Eigen::Matrix2d& trust);
  bool Evaluate(const double* const* parameters,
                double* residual,
                double** jacobians) const override;

 private:
  CameraModel camera_;
  Eigen::Isometry3d T_camera_lidar_start_;
  Eigen::Vector3d point_lidar_m_;
  Eigen::Vector2d point_px_;
  Eigen::Matrix2d trust_;
};

/// One term of the refinement: weight * huber(|residual|^2).
struct RefineTerm {
  int pose = 0;  ///< Index into the samples.
  double weight = 0.0;
  std::unique_ptr<ceres::CostFunction> cost;
};

/// B = (I + P C P^T / scale_px^2)^-1/2 with C the point's covariance by that of the lidar's pose
/// and P its projection: one for a whole sighting, and next to nothing where open sides leave the
/// point uncertain by much more than `scale_px`.
Eigen::Matrix2d PointTrust(const LidarBoard& lidar,
                           const Eigen::Vector3d& point_lidar_m,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           double scale_px);

/// Every term with a weight, pose by pose: centre, then corners 0..3, the lidar's in the camera's
/// order.
std::vector<RefineTerm> MakeRefineTerms(const std::vector<const BoardSample*>& samples,
                                        const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_lidar_start,
                                        const RefineOptions& options);

}  // namespace voqcal
