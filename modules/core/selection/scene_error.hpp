#pragma once

#include <array>
#include <vector>

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

/// How far an extrinsic made from some poses will put the whole scene's board centres from where
/// the camera sees them, by the noise of the detectors and before anything is calibrated.
///
/// One pose measures T_camera_lidar by rotation and centre of the board, with the covariance of
/// both sensors together,
///     r = [Log(R_camera_board (R R_lidar_board)^T); c_camera - (R c_lidar + t)]
///     C = C_camera + A C_lidar A^T,   A = diag(R, R)
///     J = dr / d delta = -[I 0; -[R c_lidar]x I],   L = J^T C^-1 J
/// (delta as in PerturbLeft). The least covariance that poses S allow is (sum of L over S)^-1, and
/// pushed through the projection onto the centres s of the scene it predicts the mean square
///     e^2 = trace((sum over S of L)^-1 M),   M = mean over s of m_s^2 P_s^T P_s
/// with P_s = d pixel / d delta and m_s the metres a pixel at s: the paper's millimetres.
class SceneErrorPredictor {
 public:
  /// @param T_camera_lidar  where J and P are taken; a few degrees off change nothing of note.
  ///     Poses whose centre it puts out of the camera's sight are not part of the scene.
  SceneErrorPredictor(const std::vector<BoardSample>& scene,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const NominalNoise& nominal);

  /// e of three poses, millimetres RMS; infinite if they leave the extrinsic open.
  double PredictMm(const std::array<int, 3>& poses) const;

 private:
  std::vector<Matrix6d> information_;     // L of each pose
  Matrix6d scene_m2_ = Matrix6d::Zero();  // M
};

}  // namespace voqcal
