#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

#include "core/board/board_sample.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// What the thousand returns and hundred corners of one board share, and no detector can tell from
/// inside one frame: 1 sigma of the difference between the two sensors, beyond their covariances.
/// Ranges that are off by angle and shade, a bent board, an outline that is not cut square, the
/// lens model's error at that place, the time between the two frames.
struct SightingErrors {
  double along_ray_m = 0.0;  ///< Of the centre, along the camera's ray.
  /// Of the centre, across the ray and the lidar's z: along the scan lines of a lidar that turns
  /// about it. Time between the two frames shows here, and how the beam's width moves upright
  /// edges.
  double level_m = 0.0;
  double upright_m = 0.0;  ///< Of the centre, across the ray and that.
  double tilt_rad = 0.0;   ///< Of the normal, in each direction.
  double turn_rad = 0.0;   ///< About the normal.

  /// Of [rotation_rad; translation_m] of one board, camera axes.
  Matrix6d CovarianceOf(const BoardPose& pose_camera, const Eigen::Matrix3d& R_camera_lidar) const;
};

/// The variances of SightingErrors, in its order.
enum SightingError : std::size_t {
  kAlongRayError,
  kLevelError,
  kUprightError,
  kTiltError,
  kTurnError,
  kNumSightingErrors
};
using SightingVariances = std::array<double, kNumSightingErrors>;
SightingVariances SquaresOf(const SightingErrors& errors);
SightingErrors RootsOf(const SightingVariances& variances);

/// By order of magnitude what boards of real rigs show (`voqcal_figures field --verbose`): normals
/// of a biased lidar are off by about a degree, ranges by one or two centimetres.
constexpr SightingErrors kPriorErrors{0.02, 0.005, 0.005, 0.02, 0.005};
/// How many observations each of these counts for: the two across the ray together for one.
constexpr SightingVariances kPriorWeights{1.0, 0.5, 0.5, 1.0, 1.0};

/// What the sightings of a session share, so that no number of them averages it out.
struct SharedErrors {
  double range_offset_m = 0.0;  ///< Of all the lidar's ranges.
  /// Of the outlines' height, along the lidar's z: scan lines cut the outline coarsely, and always
  /// at the same elevations...
  double outline_lift_m = 0.0;
  double outline_rise = 0.0;  ///< ...growing with the range: metres a metre.
  /// Of all chessboards' rotations against the rays to their centres, about the camera's x and y. A
  /// principal point that is given wrongly turns the rays, and leaves boards that face the camera
  /// as they are: who believes both is off between them. (Offsets of scan lines that grow with the
  /// elevation turn the lidar's planes, and look the same from here.)
  double chessboard_turn_x_rad = 0.0;
  double chessboard_turn_y_rad = 0.0;
};

/// Both chessboard_turns as estimated.
struct ChessboardTurn {
  Eigen::Vector2d value_rad = Eigen::Vector2d::Zero();
  Eigen::Vector2d standard_error_rad =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< NaN: not estimated.
};

/// 1 sigma of a chessboard_turn before the data speak: a principal point that is 10 px off, of a
/// focal length of 1000.
constexpr double kPriorChessboardTurnRad = 0.01;

/// 1 sigma of each before the data speak. The heights' is twice the likelihood's, which takes out
/// what the scan lines' offsets do to the outline's plane.
constexpr SharedErrors kPriorSharedErrors{
    0.03, 0.002, 0.001, kPriorChessboardTurnRad, kPriorChessboardTurnRad};

/// What is known of the errors of a session's sightings before it speaks: those of a lidar and a
/// camera, unless told otherwise.
struct ErrorPriors {
  SightingErrors sighting = kPriorErrors;
  SharedErrors shared = kPriorSharedErrors;
};

/// 1 sigma of the chessboard_turn between two cameras: the fit knows of the second's alone, and the
/// first's has its form as far as the cameras look the same way.
constexpr double kPriorTurnBetweenCamerasRad = M_SQRT2 * kPriorChessboardTurnRad;

/// Of two cameras: by order of magnitude what a lens model's errors do to a board. They have none
/// of a lidar's shared errors.
constexpr ErrorPriors kCameraErrorPriors{
    {0.003, 0.001, 0.001, 0.005, 0.001},
    {1e-6, 1e-6, 1e-6, kPriorTurnBetweenCamerasRad, kPriorTurnBetweenCamerasRad}};

/// How one board's covariance grows with the square of each error, in the order of the struct.
std::array<Matrix6d, kNumSightingErrors> UnitCovariances(const BoardPose& pose_camera,
                                                         const Eigen::Matrix3d& R_camera_lidar);

}  // namespace voqcal
