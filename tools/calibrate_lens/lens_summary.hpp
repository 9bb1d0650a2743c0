#pragma once

#include <optional>
#include <string>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lens_calibration/lens_calibration.hpp"

namespace voqcal {

/// The camera to as many digits as mean something: pixels to a thousandth, coefficients to 1e-7.
CameraModel Rounded(const CameraModel& camera);

/// What a calibration found, for people: errors, each parameter with its 1 sigma, where corners
/// were and how boards were held, and what would make it better.
/// @param given  the rig file's own intrinsics, to compare with.
std::string LensSummary(const LensCalibration& calibration,
                        const BoardSpec& board,
                        const std::optional<CameraModel>& given);

}  // namespace voqcal
