#include "core/sampling/average_sightings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// The same board by the half-turn whose x axis is nearer to the reference's.
bool IsTurned(const BoardPose& pose, const BoardPose& reference) {
  const Eigen::Vector3d x = pose.corners_m[1] - pose.corners_m[0];
  const Eigen::Vector3d x_reference = reference.corners_m[1] - reference.corners_m[0];
  return x.dot(x_reference) < 0;
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
  mean.log_likelihood = 0;
  double sum_squares_m2 = 0;
  for (const LidarBoard& each : boards) {
    const bool is_turned = IsTurned(each.pose, boards.front().pose);
    poses.push_back(is_turned ? TurnedByHalf(each.pose) : each.pose);
    for (std::size_t i = 0; i < 4; ++i) {
      mean.edge_lengths_m[i] += each.edge_lengths_m[is_turned ? (i + 2) % 4 : i] / n;
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
    const bool is_turned = IsTurned(each.pose, boards.front().pose);
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
