#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/lidar_board.hpp"

namespace voqcal {

/// A rectangular plate as the lidar sees it; which of its edges is the board's width, it cannot
/// tell.
struct PlateSize {
  double longer_m = 0.0;
  double shorter_m = 0.0;
  double sigma_m = 0.0;  ///< Of either; the spill's share is common to both.
  int num_places = 0;    ///< Where it was seen.
};

/// Measures the plate on which a pattern is, by sweeps between which it moved: of all rectangles
/// that the pattern fits on, it is the one that is found at most places. Doors and cupboards are
/// found at one.
///
/// @param pattern  square and corner counts count; the plate's edges do not.
/// @param on_progress  called with the share done.
/// @return nothing if no size is found at three places or more, or two are found at as many.
/// @throws std::invalid_argument if `options` have Problems().
std::optional<PlateSize> MeasurePlateSize(const std::vector<PointCloud>& sweeps_lidar_m,
                                          const BoardSpec& pattern,
                                          const LidarBoardOptions& options,
                                          const std::function<void(double)>& on_progress = {});

}  // namespace voqcal
