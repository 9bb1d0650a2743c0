#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar/shade_scale.hpp"

namespace voqcal {

/// Scan lines with an offset of their own; no lidar has more, but a damaged cloud may.
constexpr std::size_t kMaxRings = 256;

/// One fault of the lidar's ranges, metres. What the data cannot tell stays zero.
struct BiasEstimate {
  double value_m = 0.0;
  double standard_error_m = std::numeric_limits<double>::quiet_NaN();
  bool is_observable = false;  ///< The data narrow the prior to a half or less.

  std::string Text() const;  ///< "12.3 +- 0.8 mm" or "unobservable".
};

/// The scale of all the boards' points.
ShadeScale MakeShadeScale(const std::vector<const BoardSample*>& samples);

/// Systematic errors of a lidar. Ranges: measured = true + common + dark_step * shade + ring
/// offset.
struct LidarBias {
  BiasEstimate common;
  BiasEstimate dark_step;           ///< How much longer dark surfaces read than bright ones.
  std::vector<BiasEstimate> rings;  ///< Offset of each scan line; empty if the cloud has no rings.
  ShadeScale shades;
  BiasEstimate outline_lift;  ///< How much higher (along z) outlines look than they are...
  BiasEstimate outline_rise;  ///< ...and how much more so for each metre of range: metres a metre.

  bool IsObservable() const;  ///< Any of them.
  /// Of a point of such a cloud; intensity and scan line count only if the cloud has them.
  double OffsetM(const LidarPoint& point, const PointCloud& cloud) const;
  /// The cloud without these errors: each point moves along its ray.
  PointCloud Corrected(const PointCloud& cloud_lidar_m) const;
};

/// The board as the lidar would have seen it without `bias`: the plane of the corrected points, and
/// in it the outline along the rays that it was seen by. Errors of range leave the rays alone.
/// Without points it is the pose as it was measured.
BoardPose CorrectedPose(const LidarBoard& lidar, const LidarBias& bias);

}  // namespace voqcal
