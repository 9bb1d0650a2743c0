#include "core/assessment/given_session.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/camera_detection/planar_pose.hpp"
#include "core/parallel.hpp"

namespace voqcal {
namespace {

std::optional<BoardSample> SeenAgain(const BoardSample& sample,
                                     const std::vector<Eigen::Vector3d>& corners_board_m,
                                     const GivenSession& session) {
  if (sample.camera.corners_px.size() != corners_board_m.size()) return std::nullopt;
  const auto fit = FitSeenCorners(session.camera, corners_board_m, sample.camera.corners_px);
  if (!fit) return std::nullopt;
  BoardSample seen = sample;
  seen.camera.pose = PoseFromTransform(fit->T_camera_board, session.board);
  seen.camera.pose.covariance = fit->covariance;
  seen.camera.reprojection_rms_px = fit->reprojection_rms_px;
  return seen;
}

Eigen::Vector3d Mirrored(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

// A mirror turns the corners' order round; corner 0 stays the first of a width's edge.
BoardPose Mirrored(const BoardPose& pose) {
  const Matrix6d flip = (Vector6d() << -1, 1, -1, 1, -1, 1).finished().asDiagonal();
  BoardPose mirrored;
  mirrored.centre_m = Mirrored(pose.centre_m);
  mirrored.normal = Mirrored(pose.normal);
  constexpr std::array<std::size_t, 4> kOrder = {1, 0, 3, 2};
  for (std::size_t i = 0; i < 4; ++i) mirrored.corners_m[i] = Mirrored(pose.corners_m[kOrder[i]]);
  mirrored.covariance = flip * pose.covariance * flip;
  return mirrored;
}

void Mirror(LidarBoard* board) {
  board->pose = Mirrored(board->pose);
  std::swap(board->edge_lengths_m[1], board->edge_lengths_m[3]);
  std::swap(board->sides[1], board->sides[3]);
  for (LidarPoint& point : board->points_lidar_m.points) {
    point.position_m.y() = -point.position_m.y();
  }
}

}  // namespace

void SeeBoardsAgain(GivenSession* session) {
  const std::vector<Eigen::Vector3d> corners_board_m = session->board.InnerCornersBoardM();
  std::vector<std::optional<BoardSample>> seen(session->samples.size());
  ParallelFor(seen.size(), [&](std::size_t i) {
    seen[i] = SeenAgain(session->samples[i], corners_board_m, *session);
  });
  session->samples.clear();
  for (std::optional<BoardSample>& sample : seen) {
    if (sample) session->samples.push_back(std::move(*sample));
  }
}

void MirrorLidar(GivenSession* session) {
  for (BoardSample& sample : session->samples) {
    Mirror(&sample.lidar);
    for (LidarBoard& other : sample.runners_up) Mirror(&other);
  }
}

void LayPatternAcross(GivenSession* session) {
  BoardSpec& board = session->board;
  const auto num_x = static_cast<std::size_t>(board.num_corners_x);
  const auto num_y = static_cast<std::size_t>(board.num_corners_y);
  for (BoardSample& sample : session->samples) {
    const std::vector<Eigen::Vector2d> corners_px = sample.camera.corners_px;
    if (corners_px.size() != num_x * num_y) continue;
    // The pattern's x becomes its y, and its -y its x.
    std::size_t i = 0;
    for (std::size_t y = 0; y < num_x; ++y) {
      for (std::size_t x = 0; x < num_y; ++x) {
        sample.camera.corners_px[i++] = corners_px[(num_y - 1 - x) * num_x + y];
      }
    }
  }
  std::swap(board.num_corners_x, board.num_corners_y);
  SeeBoardsAgain(session);
}

void ShiftPairs(int by, GivenSession* session) {
  const std::vector<BoardSample> given = std::move(session->samples);
  session->samples.clear();
  const int num = static_cast<int>(given.size());
  for (int i = 0; i < num; ++i) {
    if (i - by < 0 || i - by >= num) continue;
    BoardSample sample = given[static_cast<std::size_t>(i)];
    const BoardSample& other = given[static_cast<std::size_t>(i - by)];
    sample.lidar = other.lidar;
    sample.runners_up = other.runners_up;
    session->samples.push_back(std::move(sample));
  }
}

}  // namespace voqcal
