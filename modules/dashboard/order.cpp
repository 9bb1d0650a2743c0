#include "dashboard/order.hpp"

#include <algorithm>

#include "core/guidance/advice.hpp"
#include "messaging/convert_result.hpp"

namespace voqcal {
namespace {

// What a hand holds still within; the guide counts on no more.
constexpr double kThereM = 0.10;

/// Of the asked corners from the seen ones, the board perhaps turned by half a turn, on average.
double MeanDistanceM(const double (&asked_m)[4][3], const BoardPose& seen, std::size_t turned_by) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Map<const Eigen::Vector3d> asked(asked_m[i]);
    sum_m += (asked - seen.corners_m[(i + turned_by) % 4]).norm();
  }
  return sum_m / 4.0;
}

}  // namespace

Order OrderFor(const next_pose_t& next,
               const std::optional<BoardPose>& board_camera,
               const CameraModel& camera) {
  if (!next.problem.empty() || next.is_enough != 0) return {next.advice};
  const Eigen::Isometry3d T_camera_board = FromMessage(next.T_camera_board);
  if (!board_camera) return {HoldWords(T_camera_board, {}, camera)};
  const double away_m = std::min(MeanDistanceM(next.corners_camera_m, *board_camera, 0),
                                 MeanDistanceM(next.corners_camera_m, *board_camera, 2));
  if (away_m < kThereM) return {"It is there: hold it still.", away_m};
  return {HoldWords(T_camera_board, board_camera->centre_m, camera), away_m};
}

}  // namespace voqcal
