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

/// Which sides tell where the board ends: those that are measured, and those that hits come up to
/// where beams past them would come back from nothing: the sky, or what a cropped cloud left out.
std::array<bool, 4> ToldSides(const Measurement& m,
                              const BeamIndex& beams,
                              const std::array<OutlineEdge, 4>& edges);

/// Whether what was measured has the board's size: the edges between two sides that are told.
bool HasRightSize(const Measurement& m,
                  const std::array<OutlineEdge, 4>& edges,
                  const std::array<double, 4>& measured_m,
                  const std::array<double, 4>& true_m,
                  const std::array<bool, 4>& is_told);

/// Why what was measured may be something else, naming the first side that is open; nothing if it
/// is the board.
std::optional<NoLidarBoard> Doubt(const Measurement& m,
                                  const Agreement& agreement,
                                  const std::array<bool, 4>& is_told);

/// That the board is certainly bent, and by how much; nothing if it may be flat.
std::optional<NoLidarBoard> Bend(const Measurement& m,
                                 const PointCloud& cloud_lidar_m,
                                 double max_bend_m);

/// Whether the beams leave the rectangle too free, or free to be turned.
bool IsLoose(const Measurement& m, double max_sigma_m);

}  // namespace voqcal
