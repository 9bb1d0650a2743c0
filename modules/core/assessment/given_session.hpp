#pragma once

#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Samples, with what the rig file says of the board and the camera that they were taken with.
struct GivenSession {
  BoardSpec board;
  CameraModel camera;
  std::vector<BoardSample> samples;
};

/// Had the rig file said what `session` says: each camera's board anew from its corners' pixels.
/// Samples whose corners fit no pose go, as do those whose corners were not kept (features read
/// from a table).
void SeeBoardsAgain(GivenSession* session);

/// Had the lidar's y axis pointed the other way: boards and points.
void MirrorLidar(GivenSession* session);

/// Had the pattern been said to lie across the plate: num_corners_x and num_corners_y swapped.
void LayPatternAcross(GivenSession* session);

/// Had each image been paired with the sweep of `by` pairs before (after, if negative).
void ShiftPairs(int by, GivenSession* session);

}  // namespace voqcal
