#pragma once

#include <array>
#include <optional>

#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/board_measurement.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/lidar_board_miss.hpp"
#include "core/lidar_detection/outline_checks.hpp"
#include "core/lidar_detection/outline_edges.hpp"

namespace voqcal {

/// The side on which the outline is open, and what is there instead; nothing if it is closed.
/// `slack` above 1 loosens it for a rough fit.
std::optional<NoLidarBoard> OpenSide(const Measurement& m,
                                     const BeamIndex& beams,
                                     const std::array<OutlineEdge, 4>& edges,
                                     const Agreement& agreement,
                                     double slack);

/// The side past which what is seen does not prove that the board ends there: it may go on behind
/// what stands before the plane, or the next scan line still meets the plane; nothing if there is
/// none.
std::optional<NoLidarBoard> UnprovenSide(const Measurement& m);

/// Whether the edges are as long as the board's, as far as the beams tell.
bool HasRightSize(const Measurement& m,
                  const std::array<OutlineEdge, 4>& edges,
                  const std::array<double, 4>& measured_m,
                  const std::array<double, 4>& true_m);

/// That the board is certainly bent, and by how much; nothing if it may be flat.
std::optional<NoLidarBoard> Bend(const Measurement& m,
                                 const PointCloud& cloud_lidar_m,
                                 double max_bend_m);

/// Whether the beams leave the rectangle too free, or free to be turned.
bool IsLoose(const Measurement& m, double max_sigma_m);

}  // namespace voqcal
