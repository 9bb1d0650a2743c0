#include "core/sampling/average_sightings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/board/half_turn.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// By how many quarters a sighting's axes must be turned to be nearest to the reference's.
int TurnTo(const BoardPose& reference, const BoardPose& pose) {
  const Eigen::Vector3d x_reference = reference.corners_m[1] - reference.corners_m[0];
  return BestTurn(pose, [&x_reference](const BoardPose& turned) {
    return -x_reference.dot(turned.corners_m[1] - turned.corners_m[0]);
  });
}

// Of the camera's: the pattern tells quarters apart.
bool IsTurnedByHalf(const BoardPose& reference, const BoardPose& pose) {
  const Eigen::Vector3d x = pose.corners_m[1] - pose.corners_m[0];
  return x.dot(reference.corners_m[1] - reference.corners_m[0]) < 0;
}

// Mean of poses that differ by noise. The covariance stays that of one frame: what it covers beside
// noise (ring offsets, the outline's model, the lens) is the same in every frame of a resting
// board, and averaging does not lessen it.
BoardPose MeanPose(const std::vector<BoardPose>& poses, const BoardSpec& board) {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Isometry3d T_sensor_board = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();
  const double n = static_cast<double>(poses.size());
  for (const BoardPose& pose : poses) {
    rotations.push_back(TransformFromPose(pose).linear());
    T_sensor_board.translation() += pose.centre_m / n;
    covariance += pose.covariance / n;
  }
  T_sensor_board.linear() = MeanRotation(rotations);
  BoardPose mean = PoseFromTransform(T_sensor_board, board);
  mean.covariance = covariance;
  return mean;
}

}  // namespace

LidarBoard MeanLidarBoard(const std::vector<LidarBoard>& boards, const BoardSpec& board) {
  if (boards.empty()) throw std::invalid_argument("no frames to average");
  if (boards.size() == 1) return boards.front();
  LidarBoard mean = boards.back();
  const double n = static_cast<double>(boards.size());
  std::vector<BoardPose> poses;
  mean.edge_lengths_m.fill(0);
  mean.sides.fill(SideView::kMeasured);
  mean.log_likelihood = 0;
  double sum_squares_m2 = 0;
  for (const LidarBoard& each : boards) {
    const int turn = TurnTo(boards.front().pose, each.pose);
    poses.push_back(TurnedByQuarters(each.pose, turn));
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t turned = (i + static_cast<std::size_t>(turn)) % 4;
      mean.edge_lengths_m[i] += each.edge_lengths_m[turned] / n;
      // What one frame leaves open, the mean of all does.
      if (mean.sides[i] == SideView::kMeasured) mean.sides[i] = each.sides[turned];
    }
    mean.log_likelihood += each.log_likelihood / n;
    sum_squares_m2 += each.plane_rms_m * each.plane_rms_m;
  }
  mean.pose = MeanPose(poses, board);
  mean.plane_rms_m = std::sqrt(sum_squares_m2 / n);
  return mean;
}

CameraBoard MeanCameraBoard(const std::vector<CameraBoard>& boards, const BoardSpec& board) {
  if (boards.empty()) throw std::invalid_argument("no frames to average");
  if (boards.size() == 1) return boards.front();
  CameraBoard mean = boards.front();
  const double n = static_cast<double>(boards.size());
  std::vector<BoardPose> poses;
  std::fill(mean.corners_px.begin(), mean.corners_px.end(), Eigen::Vector2d::Zero());
  double sum_squares_px2 = 0;
  for (const CameraBoard& each : boards) {
    const bool is_turned = IsTurnedByHalf(boards.front().pose, each.pose);
    poses.push_back(is_turned ? TurnedByHalf(each.pose) : each.pose);
    const std::size_t num_corners = each.corners_px.size();
    for (std::size_t i = 0; i < num_corners; ++i) {
      mean.corners_px[i] += each.corners_px[is_turned ? num_corners - 1 - i : i] / n;
    }
    sum_squares_px2 += each.reprojection_rms_px * each.reprojection_rms_px;
  }
  mean.pose = MeanPose(poses, board);
  mean.reprojection_rms_px = std::sqrt(sum_squares_px2 / n);
  return mean;
}

}  // namespace voqcal
