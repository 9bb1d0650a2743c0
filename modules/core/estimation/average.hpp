#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/estimation/set_extrinsic.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

struct AverageOptions {
  double max_z_score = 2.0;  ///< Sets beyond this many standard deviations in any parameter go.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The mean of the set results, as published: one z-score filter, then mean and spread.
struct AveragedExtrinsic {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Sample standard deviation of [rotation_rad; translation_m] of the kept sets, on the left side.
  /// NaN if fewer than two were kept: one result shows no spread.
  Vector6d spread = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> is_kept;  ///< One for each set; unusable sets are never kept.
  /// One for each set: why it was dropped, for people; empty if it was kept.
  std::vector<std::string> reasons;
  int num_kept = 0;  ///< 0: nothing to average, the transform is meaningless.

  bool IsUsable() const { return num_kept > 0; }
};

/// Rotations are averaged on the group (MeanRotation), and each set's z-score in a rotation
/// parameter is that of its left difference from the mean. One pass, as published: the rest is not
/// filtered again.
/// @throws std::invalid_argument if `options` has Problems().
AveragedExtrinsic AverageExtrinsics(const std::vector<SetExtrinsic>& sets,
                                    const AverageOptions& options);

}  // namespace voqcal
