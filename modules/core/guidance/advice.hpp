#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// How to hold the board so, in words, for who looks at the image: left, right and up are the
/// image's. Lengths are rounded to 10 cm, or to half metres from 1.5 m on, angles to 10 degrees,
/// turns about the normal to 45: what a person can do.
///
/// "Move the board 1 m away from the camera, half a metre to the left. Hold it as a diamond, the
/// top 30 degrees towards the camera."
/// @param last_centre_camera_m  where the board was last; nothing: the words start from the camera.
std::string HoldWords(const Eigen::Isometry3d& T_camera_board,
                      const std::optional<Eigen::Vector3d>& last_centre_camera_m,
                      const CameraModel& camera);

}  // namespace voqcal
