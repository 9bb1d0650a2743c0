#include "messaging/convert_guidance.hpp"

#include "messaging/convert_result.hpp"

namespace voqcal {
namespace {

using Corners = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;

Corners CornersOf(const BoardPose& pose) {
  Corners corners_m;
  for (Eigen::Index i = 0; i < 4; ++i) {
    corners_m.row(i) = pose.corners_m[static_cast<std::size_t>(i)].transpose();
  }
  return corners_m;
}

void FillPose(const NextPose& next,
              const BoardSpec& board,
              const CameraModel& camera,
              next_pose_t* message) {
  const BoardPose in_camera = PoseFromTransform(next.T_camera_board, board);
  Eigen::Map<Corners>(&message->corners_camera_m[0][0]) = CornersOf(in_camera);
  for (std::size_t i = 0; i < in_camera.corners_m.size(); ++i) {
    const Eigen::Vector2d pixel_px = camera.Project(in_camera.corners_m[i]);
    message->corners_px[i][0] = pixel_px.x();
    message->corners_px[i][1] = pixel_px.y();
  }
  if (!next.T_lidar_board) return;
  message->is_lidar_known = 1;
  message->T_lidar_board = ToMessage(*next.T_lidar_board);
  Eigen::Map<Corners>(&message->corners_lidar_m[0][0]) =
      CornersOf(PoseFromTransform(*next.T_lidar_board, board));
}

}  // namespace

next_pose_t ToMessage(const NextPose& next,
                      const GuidanceOptions& asked,
                      const BoardSpec& board,
                      const CameraModel& camera) {
  next_pose_t message{};
  message.problem = next.problem;
  message.advice = next.advice;
  message.unit = ToString(asked.enough.tolerance.unit);
  message.tolerance = asked.enough.tolerance.tolerance;
  message.min_range_m = asked.enough.tolerance.min_range_m;
  message.max_range_m = asked.enough.tolerance.max_range_m;
  message.min_samples = asked.enough.min_samples;
  message.worst_error = next.worst.error;
  message.is_enough = next.is_enough ? 1 : 0;
  message.worst_range_m = next.worst.range_m;
  Eigen::Map<Eigen::Vector2d>(message.worst_px) = next.worst.pixel_px;
  Eigen::Map<Eigen::Vector3d>(message.worst_camera_m) = next.worst.point_camera_m;
  message.predicted_worst_error = next.predicted_worst_error;
  message.T_camera_board = ToMessage(next.T_camera_board);
  message.T_lidar_board = ToMessage(Eigen::Isometry3d::Identity());
  if (next.problem.empty()) FillPose(next, board, camera, &message);
  return message;
}

}  // namespace voqcal
