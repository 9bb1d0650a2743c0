#pragma once

#include <array>

#include "core/board/board_sample.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// What the thousand returns and hundred corners of one board share, and no detector can tell from
/// inside one frame: 1 sigma of the difference between the two sensors, beyond their covariances.
/// Ranges that are off by angle and shade, a bent board, an outline that is not cut square, the
/// lens model's error at that place, the time between the two frames.
struct SightingErrors {
  double along_ray_m = 0.0;   ///< Of the centre, along the camera's ray.
  double across_ray_m = 0.0;  ///< Of the centre, in each direction across it.
  double tilt_rad = 0.0;      ///< Of the normal, in each direction.
  double turn_rad = 0.0;      ///< About the normal.

  /// Of [rotation_rad; translation_m] of one board, camera axes.
  Matrix6d CovarianceOf(const BoardPose& pose_camera) const;
};

/// Of SightingErrors, in its order.
using SightingVariances = std::array<double, 4>;
SightingVariances SquaresOf(const SightingErrors& errors);
SightingErrors RootsOf(const SightingVariances& variances);

/// By order of magnitude what boards of real rigs show (`voqcal_figures field --verbose`): normals
/// of a biased lidar are off by about a degree, ranges by one or two centimetres.
constexpr SightingErrors kPriorErrors{0.02, 0.005, 0.02, 0.005};

/// What the sightings of a session share, so that no number of them averages it out.
struct SharedErrors {
  double range_offset_m = 0.0;  ///< Of all the lidar's ranges.
  /// Of the outlines' height, along the lidar's z: scan lines cut the outline coarsely, and always
  /// at the same elevations...
  double outline_lift_m = 0.0;
  double outline_rise = 0.0;  ///< ...growing with the range: metres a metre.
};

/// 1 sigma of each before the data speak. The heights' is twice the likelihood's, which takes out
/// what the scan lines' offsets do to the outline's plane.
constexpr SharedErrors kPriorSharedErrors{0.03, 0.002, 0.001};

/// What is known of the errors of a session's sightings before it speaks: those of a lidar and a
/// camera, unless told otherwise.
struct ErrorPriors {
  SightingErrors sighting = kPriorErrors;
  SharedErrors shared = kPriorSharedErrors;
};

/// Of two cameras: by order of magnitude what a lens model's errors do to a board. They have none
/// of a lidar's shared errors.
constexpr ErrorPriors kCameraErrorPriors{{0.003, 0.001, 0.005, 0.001}, {1e-6, 1e-6, 1e-6}};

/// How one board's covariance grows with the square of each error, in the order of the struct.
std::array<Matrix6d, 4> UnitCovariances(const BoardPose& pose_camera);

}  // namespace voqcal
