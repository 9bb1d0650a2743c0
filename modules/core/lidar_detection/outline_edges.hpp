#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// What the beams near one edge say of it, without the known size.
struct OutlineEdge {
  double offset_m = 0.0;  ///< Of the measured edge beyond the fitted rectangle's, at its middle.
  double offset_sigma_m = 0.0;  ///< Standard error of the offset.
  double slope = 0.0;           ///< Change of the offset along the edge (counter-clockwise).
  int num_hits = 0;             ///< Beams near it on the board...
  int num_misses = 0;           ///< ...and past it.
  double reach_m =
      0.0;  ///< How far beyond the rectangle's edge the outermost hits lie (< 0: short).
};

/// From the rectangle's centre towards edge `i`, in its axes, unit length.
Eigen::Vector2d OutwardOf(std::size_t edge);

/// Each edge, in BoardSpec's order (edge i joins corner i to corner i + 1), as a line of its own:
/// the logistic model of OutlineModel with one side and free offset and slope.
std::array<OutlineEdge, 4> MeasureEdges(const std::vector<OutlineBeam>& beams,
                                        const OutlineModel& model,
                                        const RectanglePose& pose);

/// Lengths of the quadrilateral that the four lines enclose.
std::array<double, 4> EdgeLengthsM(const std::array<OutlineEdge, 4>& edges,
                                   const OutlineModel& model);

}  // namespace voqcal
