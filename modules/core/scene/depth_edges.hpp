#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Where a nearer surface ends along a scan line, before a farther one.
struct DepthEdge {
  /// At the nearer surface's range, half-way between its last ray and the next: the true edge lies
  /// between the last hit and the first miss.
  Eigen::Vector3f position_lidar_m = Eigen::Vector3f::Zero();
  /// Along the scan line, towards the farther surface; unit length.
  Eigen::Vector3f outward_lidar = Eigen::Vector3f::Zero();
  float step_rad = 0.0F;  ///< Between the two rays.
};

struct DepthEdgeOptions {
  double min_jump_m = 0.3;     ///< The next return is so much farther.
  double max_step_rad = 0.02;  ///< Neighbours of a scan line are at most this far apart.
  double min_range_m = 0.5;    ///< Nearer returns are the vehicle's own.
};

/// The edges of one sweep, scan line by scan line, in order of azimuth. Returns of one ring, or
/// else of one elevation, are neighbours.
std::vector<DepthEdge> FindDepthEdges(const PointCloud& cloud_lidar_m,
                                      const DepthEdgeOptions& options);

}  // namespace voqcal
