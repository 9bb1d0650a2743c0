#include "core/board/board_sample.hpp"

#include <algorithm>
#include <stdexcept>

namespace voqcal {

std::string ToString(SideView view) {
  switch (view) {
    case SideView::kMeasured:
      return "measured";
    case SideView::kJoined:
      return "joined";
    case SideView::kHidden:
      return "hidden";
    case SideView::kCutOff:
      return "cut off";
    case SideView::kGap:
      return "in a gap";
  }
  throw std::logic_error("unknown SideView");
}

int NumMeasuredSides(const LidarBoard& board) {
  return static_cast<int>(std::count(board.sides.begin(), board.sides.end(), SideView::kMeasured));
}

Eigen::Isometry3d TransformFromPose(const BoardPose& pose) {
  const auto& c = pose.corners_m;
  Eigen::Matrix3d axes;
  axes.col(0) = ((c[1] - c[0]) + (c[2] - c[3])).normalized();
  axes.col(1) = ((c[3] - c[0]) + (c[2] - c[1])).normalized();
  axes.col(2) = pose.normal;
  Eigen::Isometry3d T_sensor_board = Eigen::Isometry3d::Identity();
  T_sensor_board.linear() = NearestRotation(axes);
  T_sensor_board.translation() = pose.centre_m;
  return T_sensor_board;
}

BoardPose PoseFromTransform(const Eigen::Isometry3d& T_sensor_board, const BoardSpec& board) {
  BoardPose pose;
  pose.centre_m = T_sensor_board.translation();
  pose.normal = T_sensor_board.linear().col(2);
  const auto outline_board_m = board.OutlineBoardM();
  for (std::size_t i = 0; i < 4; ++i) pose.corners_m[i] = T_sensor_board * outline_board_m[i];
  return pose;
}

BoardPose TurnedByHalf(const BoardPose& pose) {
  BoardPose turned = pose;
  for (std::size_t i = 0; i < 4; ++i) turned.corners_m[i] = pose.corners_m[(i + 2) % 4];
  return turned;
}

std::vector<std::int64_t> IdsOf(const std::vector<const BoardSample*>& samples) {
  std::vector<std::int64_t> ids;
  for (const BoardSample* sample : samples) ids.push_back(sample->id);
  return ids;
}

std::vector<const BoardSample*> SamplesWithout(const std::vector<BoardSample>& samples,
                                               const std::vector<std::int64_t>& left_out_ids) {
  std::vector<const BoardSample*> kept;
  for (const BoardSample& sample : samples) {
    const bool is_left_out =
        std::find(left_out_ids.begin(), left_out_ids.end(), sample.id) != left_out_ids.end();
    if (!is_left_out) kept.push_back(&sample);
  }
  return kept;
}

}  // namespace voqcal
