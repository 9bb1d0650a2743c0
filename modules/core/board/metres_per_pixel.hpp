#pragma once

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Metres on the board per pixel at the board: mean length of the outline's two diagonals in metres
/// over their mean length in pixels.
double MetresPerPixel(const BoardPose& pose_camera, const CameraModel& camera);

}  // namespace voqcal
