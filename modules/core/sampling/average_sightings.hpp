#pragma once

#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// Frames of a resting board as one: mean pose (turned to the first frame's half-turn), edges and
/// log-likelihood, root mean square of the plane's RMS, the last frame's points. The covariance
/// stays that of one frame: the errors that all frames share do not average out.
/// @throws std::invalid_argument if there is no frame.
LidarBoard MeanLidarBoard(const std::vector<LidarBoard>& boards, const BoardSpec& board);

/// The same of the camera's: mean pose and corners.
CameraBoard MeanCameraBoard(const std::vector<CameraBoard>& boards, const BoardSpec& board);

}  // namespace voqcal
