#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

enum class ErrorUnit {
  kMillimetres,  ///< Across the camera's ray.
  kPixels,
};
std::string ToString(ErrorUnit unit);  ///< "mm", "px".

/// How good is good enough, and where.
struct ErrorTolerance {
  double tolerance = 5.0;  ///< Largest predicted error (RMS) of a lidar point, in `unit`.
  ErrorUnit unit = ErrorUnit::kMillimetres;
  double min_range_m = 1.0;  ///< From the camera.
  double max_range_m = 5.0;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Where the extrinsic's error is predicted to be worst.
struct WorstError {
  double error = 0.0;  ///< In the tolerance's unit.
  double range_m = 0.0;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  Eigen::Vector3d point_camera_m = Eigen::Vector3d::Zero();
};

/// The scene in which an extrinsic is judged: a grid of rays over the whole image, at the nearest
/// and the farthest range. Nothing between is worse: along a ray the mean square in millimetres is
/// a convex quadratic of the range (J of ErrorFormsAt is affine in it), in pixels one of its
/// inverse.
class ErrorScene {
 public:
  /// @param T_camera_lidar  where the errors are linearised.
  /// @throws std::invalid_argument if `tolerance` has Problems(), or no pixel has a ray.
  ErrorScene(const CameraModel& camera,
             const Eigen::Isometry3d& T_camera_lidar,
             const ErrorTolerance& tolerance);

  /// @param covariance  of [rotation_rad; translation_m] of T_camera_lidar, left (camera) side.
  WorstError Worst(const Matrix6d& covariance) const;

  /// Of each point: trace(form * covariance) is its mean square, in the unit.
  std::vector<Matrix6d> Forms() const;

 private:
  struct Point {
    Matrix6d form = Matrix6d::Zero();  // trace(form * covariance): the mean square, in the unit
    WorstError at;                     // its error is unset
  };
  std::vector<Point> points_;
};

}  // namespace voqcal
