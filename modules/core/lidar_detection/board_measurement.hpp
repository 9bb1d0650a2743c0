#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/outline_fit.hpp"
#include "core/lidar_detection/patch_view.hpp"
#include "core/lidar_detection/side_views.hpp"

namespace voqcal {

/// Everything about one patch while it is measured.
struct Measurement {
  PatchView view;
  double hit_band_m;
  PlaneFrame frame;
  OutlineModel model;
  OutlineFit outline;
  std::array<SideEvidence, 4> sides;         // of the outline
  std::vector<OutlineBeam> telling;          // the beams that say where it is
  std::vector<std::size_t> board_hits;       // for view.Beam()
  std::vector<Eigen::Vector3d> positions_m;  // of these, dark as far as bright
};

/// The board's frame, if the rectangle in the plane is the board: of what was measured so far.
Eigen::Isometry3d TransformOf(const PlaneFrame& frame, const RectanglePose& pose);

/// Of the hits from each other, in the mean.
double SpacingM(const Measurement& m);

/// Scan line of each of the board's hits; none if the cloud names none.
std::vector<std::uint16_t> RingsOf(const Measurement& m, const PointCloud& cloud_lidar_m);

}  // namespace voqcal
