#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// How long a scene is remembered.
struct LidarBackgroundOptions {
  bool is_used = true;
  /// What has not been seen for so many sweeps is forgotten: a lidar that was turned starts anew,
  /// and a board that stands still for as long is furniture (which is no reason to refuse it).
  int memory_sweeps = 3000;
  double min_step_m = 0.2;  ///< Nearer than the background by this is something that came.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The scene behind what moves: in each direction, the farthest surface of earlier sweeps.
///
/// A board that was carried in stands before what was seen there without it; a poster of the
/// same size always hid what is behind it. Holds about half a megabyte, whatever it is shown.
class LidarBackground {
 public:
  /// @throws std::invalid_argument if `options` has Problems().
  explicit LidarBackground(const LidarBackgroundOptions& options);

  /// Share of the points that stand before what earlier sweeps saw there. 0 before the first.
  double ShareThatCame(const PointCloud& points_lidar_m) const;

  void Learn(const PointCloud& sweep_lidar_m);

 private:
  /// A direction's farthest surface, and the last sweep that saw it (0: never).
  struct Cell {
    float range_m = 0.0F;
    std::int32_t seen_in = 0;
  };

  LidarBackgroundOptions options_;
  std::vector<Cell> cells_;
  std::vector<float> nearest_m_;  // of one sweep while it is learned; kept to spare its allocation
  std::int32_t num_sweeps_ = 0;
};

}  // namespace voqcal
