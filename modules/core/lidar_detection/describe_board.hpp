#pragma once

#include <array>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/board_measurement.hpp"

namespace voqcal {

/// What a finished measurement says of the board: its pose with covariance, which sides were seen,
/// edge lengths, points.
///
/// @param lengths_m     of the outline's four edges; said where both neighbouring sides were seen.
/// @param line_sigma_m  1 sigma of a scan line's own offset of range.
LidarBoard DescribeBoard(const Measurement& m,
                         const std::array<double, 4>& lengths_m,
                         const PointCloud& cloud_lidar_m,
                         const BoardSpec& board,
                         double line_sigma_m);

}  // namespace voqcal
