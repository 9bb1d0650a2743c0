#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// What a cause is weighed against: what was given, and what came of it.
struct JudgedResult {
  BoardSpec board;
  CameraModel camera;
  Eigen::Isometry3d T_camera_lidar;
  Matrix6d covariance;        ///< Of [rotation_rad; translation_m], left (camera) side.
  BiasEstimate range_offset;  ///< Taken out of the lidar's ranges, if it is observable.
};

/// Calibrations of one camera differ by less in where its rays go: 0.7 degrees, 12 px of a focal
/// length of 1000.
inline constexpr double kMostCameraTurnRad = 0.0122173048;

/// By how many of its 95 % intervals the parameter that moves most moves: NaN if unknown.
double IntervalsOf(const Vector6d& move, const Matrix6d& covariance);

/// "it moves the result by 0.40 deg and 12 mm, 5.0 times its 95 % interval with this
/// rig file".
std::string MoveText(const Vector6d& move, const Matrix6d& covariance);

/// How far lidar points land from where they should: root mean square over the image, 2 to 20 m.
struct Landing {
  double px = 0;
  double intervals = 0;  ///< The same by the 95 % interval that the result's covariance gives it.
};

/// @param camera, move  what camera and result should be: a turn that follows a wrong principal
///     point leaves points nearly where they are, though the extrinsic is far off.
Landing LandingOf(const CameraModel& camera, const Vector6d& move, const JudgedResult& result);

}  // namespace voqcal
