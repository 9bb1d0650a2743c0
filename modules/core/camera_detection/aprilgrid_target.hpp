#pragma once

#include "core/camera_detection/calibration_target.hpp"

namespace voqcal {

/// Kalibr's board: tags of the family 36h11 with a border of two cells, a share of their size
/// apart, and small dark squares that touch the tags' corners. Tag 0 is the lower left one, the
/// next is to its right. Each tag has four corners, so that the grid has two to a tag along each
/// axis; a part is enough.
const CalibrationTarget& AprilGrid();

}  // namespace voqcal
