#pragma once

#include <Eigen/Core>

#include "core/lidar_detection/board_measurement.hpp"

namespace voqcal {

/// A bar along a whole side, as a frame or an easel has, makes the board look longer; a post or the
/// ground, which join it in part, tell on which side. What is past that side says nothing then: it
/// becomes SideView::kJoined.
void OpenLengthenedSides(Measurement* m);

/// Where the board looks longer and nothing tells on which side: how far the centre may be off for
/// that along the rectangle's x and y, metres (1 sigma); else 0.
Eigen::Vector2d LengtheningSigmaM(const Measurement& m);

}  // namespace voqcal
