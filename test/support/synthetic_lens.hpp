#pragma once

#include <stdexcept>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// Takes the samples' camera poses as the truth, seen by the camera `truth` with noise of that 1
/// sigma a corner, and replaces them by what one makes of the pixels who believes in `given`.
inline void SeeThrough(const CameraModel& truth,
                       const CameraModel& given,
                       double noise_px,
                       std::vector<BoardSample>* samples) {
  Random random(7);
  const BoardSpec board = TestBoard();
  const std::vector<Eigen::Vector3d> corners_board_m = board.InnerCornersBoardM();
  for (BoardSample& sample : *samples) {
    const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    sample.camera.corners_px.clear();
    for (const Eigen::Vector3d& corner_m : corners_board_m) {
      const Eigen::Vector3d noise = noise_px * random.NormalVector();
      sample.camera.corners_px.emplace_back(
          truth.Project(Eigen::Vector3d(T_camera_board * corner_m)) + noise.head<2>());
    }
    const auto fit = FitPlanarPose(given, corners_board_m, sample.camera.corners_px);
    if (!fit) throw std::logic_error("a synthetic board that no pose explains");
    sample.camera.pose = PoseFromTransform(fit->T_camera_board, board);
    sample.camera.pose.covariance = fit->covariance;
  }
}

}  // namespace voqcal::test
