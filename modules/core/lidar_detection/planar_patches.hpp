#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/lidar/plane_fit.hpp"

namespace voqcal {

/// What counts as a patch.
struct PatchSearchOptions {
  double voxel_m = 0.15;  ///< Side of the cells that a patch is grown from.
  double band_m = 0.045;  ///< A cell belongs to a patch if its mean is this near its plane.
  /// Spread (1 sigma) that is looked for along the shorter and the longer axis; patches with less
  /// than half of it or more than twice as much are something else.
  Eigen::Vector2d spread_m = Eigen::Vector2d(0.18, 0.25);
  /// What is farther from a patch's middle only hangs on to it; parts so near are joined.
  double max_radius_m = 0.7;
  int min_points = 30;
};

/// A planar piece of the scene, connected but for gaps of the scan.
struct PlanarPatch {
  PlaneFit plane;
  /// Mean of its cells' means, which the points' density does not shift.
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  int num_points = 0;
};

/// The planar patches of about a board's size, those with the likest spread first. The points'
/// order matters by rounding only.
std::vector<PlanarPatch> FindPlanarPatches(const std::vector<Eigen::Vector3d>& points_m,
                                           const PatchSearchOptions& options);

}  // namespace voqcal
