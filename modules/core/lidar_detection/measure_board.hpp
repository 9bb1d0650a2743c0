#pragma once

#include <optional>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/lidar_detection/planar_patches.hpp"

namespace voqcal {

/// What was measured at one place.
struct MeasuredBoard {
  LidarBoard board;
  /// Why it may be something else; nothing if it is the board.
  std::optional<NoLidarBoard> doubt;
};

/// Measures the board at one planar patch, or says why the patch is not the board: kNoPlane,
/// kSizeMismatch, kFlat or kBent.
///
/// @param beams  All returns of the sweep, also those behind the patch: they show where it ends.
Expected<MeasuredBoard, NoLidarBoard> MeasureBoard(const PlanarPatch& patch,
                                                   const BeamIndex& beams,
                                                   const PointCloud& cloud_lidar_m,
                                                   const BoardSpec& board,
                                                   const LidarBoardOptions& options);

/// The same where the board is expected, of what fits in with the prior; kNoPlane if nothing does.
Expected<MeasuredBoard, NoLidarBoard> MeasureExpectedBoard(const BoardPrior& prior,
                                                           const BeamIndex& beams,
                                                           const PointCloud& cloud_lidar_m,
                                                           const BoardSpec& board,
                                                           const LidarBoardOptions& options);

}  // namespace voqcal
