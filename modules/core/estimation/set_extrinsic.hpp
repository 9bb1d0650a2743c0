#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// How the extrinsic of one set came out.
enum class SetStatus { kConverged, kNotConverged, kDegenerate };
std::string ToString(SetStatus status);

struct SetExtrinsicOptions {
  double sigma_normal_rad = 0.02;  ///< Noise of a lidar normal: a biased lidar's is about 1 degree.
  double sigma_centre_m = 0.02;    ///< Noise of a lidar centre: mostly the range's offset.
  double sigma_centre_px = 2.5;    ///< Noise of a lidar centre across the view, as pixels.
  int max_iterations = 50;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The extrinsic that one set of poses gives.
struct SetExtrinsic {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  double cost = 0.0;  ///< Half the sum of squared residuals at the end.
  SetStatus status = SetStatus::kNotConverged;

  bool IsUsable() const { return status == SetStatus::kConverged; }
};

/// Rotation from the normals projected onto SO(3), then translation from the centres: the analytic
/// start of the baseline (Verma et al. 2019, arXiv:1904.12433).
Eigen::Isometry3d AnalyticExtrinsic(const std::vector<const BoardSample*>& set);

/// The baseline's extrinsic of one set (three or more poses), by Levenberg-Marquardt from the
/// analytic start (ceres::TinySolver: some thousand sets are solved in a row). Equations and
/// departures from the published cost: set_cost.hpp. kDegenerate: fewer than three poses, or
/// normals that spread no more than their noise, so that nothing fixes the rotation about them.
/// @throws std::invalid_argument if `options` has Problems().
SetExtrinsic EstimateSetExtrinsic(const std::vector<const BoardSample*>& set,
                                  const CameraModel& camera,
                                  const SetExtrinsicOptions& options);

}  // namespace voqcal
