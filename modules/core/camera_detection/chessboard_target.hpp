#pragma once

#include <vector>

#include "core/camera_detection/calibration_target.hpp"

namespace voqcal {

/// Dark and white squares; every inner corner must be seen.
const CalibrationTarget& Chessboard();

/// The lines between squares along an axis, `num_corners` + 2 of them.
std::vector<double> SquareLinesM(double offset_m, int num_corners, double square_m);

}  // namespace voqcal
