#pragma once

#include <cstdint>
#include <vector>

#include "core/sampling/sample_picker.hpp"

/// What a picker is given in tests: a board at some x, a frame every 0.1 s.
namespace voqcal::test {

inline constexpr std::int64_t kFrameUs = 100000;

inline BoardSpec Board() {
  BoardSpec board;
  board.width_m = 0.6;
  board.height_m = 0.8;
  board.square_m = 0.1;
  board.num_corners_x = 3;
  board.num_corners_y = 4;
  return board;
}

inline Eigen::Isometry3d PoseAt(double x_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x_m, 0.2, 3.0);
  return T;
}

inline LidarSighting Lidar(std::int64_t frame, double x_m) {
  LidarBoard board;
  board.pose = PoseFromTransform(PoseAt(x_m), Board());
  board.pose.covariance = Matrix6d::Identity();
  board.edge_lengths_m = Board().EdgeLengthsM();
  board.plane_rms_m = 0.01;
  return {frame * kFrameUs, board, {}};
}

inline CameraSighting Camera(std::int64_t frame, double x_m) {
  CameraBoard board;
  board.pose = PoseFromTransform(PoseAt(x_m), Board());
  board.pose.covariance = Matrix6d::Identity();
  board.corners_px = {{1000 * x_m, 10}, {1000 * x_m + 50, 20}};
  return {frame * kFrameUs, board, {}};
}

inline void Append(const std::vector<PickerDecision>& from, std::vector<PickerDecision>* to) {
  to->insert(to->end(), from.begin(), from.end());
}

}  // namespace voqcal::test
