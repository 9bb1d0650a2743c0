#pragma once

#include <optional>
#include <string>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "voqcal/next_pose_t.hpp"

namespace voqcal {

/// What is asked of who holds the board, from where it is now.
struct Order {
  std::string words;
  /// Of the corners from where they are asked to be, on average; NaN while the board is not seen.
  double away_m = kUnknown.x();
};

/// @param board_camera  where the camera sees the board now; nothing: the words start from the
///     camera, since the last sample may be anywhere.
Order OrderFor(const next_pose_t& next,
               const std::optional<BoardPose>& board_camera,
               const CameraModel& camera);

}  // namespace voqcal
