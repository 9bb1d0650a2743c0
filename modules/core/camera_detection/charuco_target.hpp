#pragma once

#include "core/camera_detection/calibration_target.hpp"

namespace voqcal {

/// A chessboard with a marker in each white square, as OpenCV prints it, y up. A part is enough.
const CalibrationTarget& Charuco();

}  // namespace voqcal
