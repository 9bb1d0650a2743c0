#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/pose_difference.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How far an extrinsic made from some poses will put the whole scene's board centres from where
/// the camera sees them, by the noise of the detectors and before anything is calibrated.
///
/// One pose measures T_camera_lidar by rotation and centre of the board, with the covariance of
/// both sensors together,
///     L = J^T C^-1 J
/// with J and C as in PoseDifference. The least covariance that poses S allow is (sum of L over
/// S)^-1, and pushed through the projection onto the centres s of the scene it predicts the mean
/// square
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
