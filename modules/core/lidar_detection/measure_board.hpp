#pragma once

#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/lidar_detection/planar_patches.hpp"

namespace voqcal {

/// Measures the board at one planar patch, or says why the patch is not the board: kNoPlane,
/// kSizeMismatch, kFlat, kCutOff, kGap, kHidden, kLoose or kBent.
///
/// @param beams  All returns of the sweep, also those behind the patch: they show where it ends.
Expected<LidarBoard, NoLidarBoard> MeasureBoard(const PlanarPatch& patch,
                                                const BeamIndex& beams,
                                                const PointCloud& cloud_lidar_m,
                                                const BoardSpec& board,
                                                const LidarBoardOptions& options);

}  // namespace voqcal
