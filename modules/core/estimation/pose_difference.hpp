#pragma once

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// What is taken for the lidar's noise in a sample whose detectors gave no covariance.
struct NominalNoise {
  double rotation_rad = 0.02;  ///< 1 sigma of the board's rotation, about each axis.
  double along_ray_m = 0.02;   ///< 1 sigma of its centre along the ray.
  double across_px = 2.5;      ///< 1 sigma of its centre across the ray, as pixels of the camera.
};

/// How far apart the two sensors put one board, by an extrinsic, and how far that may be chance:
///     r = [Log(R_camera_board (R R_lidar_board)^T); c_camera - (R c_lidar + t)]
///     C = C_camera + A C_lidar A^T,   A = diag(R, R)
///     J = dr / d delta = -[I 0; -[R c_lidar]x I]
/// with delta as in PerturbLeft. A lidar board that was not measured on all sides says little in
/// some directions: C is wide there.
struct PoseDifference {
  Vector6d r;  ///< [rotation_rad; translation_m], camera axes.
  Matrix6d C;
  Matrix6d J;

  /// r^T C^-1 r: about 6 where the two agree as well as their covariances say.
  double SquaredSigmas() const;
};

/// @param nominal  the lidar's noise where the sample has no covariance. Where nothing is known of
///     the camera's, the lidar's is taken for all.
PoseDifference DifferenceOf(const BoardSample& sample,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar,
                            const NominalNoise& nominal);

}  // namespace voqcal
