#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// The parts by which people are told where in the image something is: thirds of its height and
/// width, row by row from the top left.
constexpr std::size_t kNumImageParts = 9;

/// "top left", "top", ..., "bottom right".
const std::array<std::string, kNumImageParts>& ImagePartNames();

/// Outside the image the part that is nearest.
std::size_t ImagePartAt(const Eigen::Vector2d& pixel_px, const CameraModel& camera);

}  // namespace voqcal
