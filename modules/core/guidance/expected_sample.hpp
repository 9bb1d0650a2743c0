#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar_detection/lidar_board.hpp"

namespace voqcal {

/// What is expected of both sensors before they see a board. The defaults are a VLP-16's.
struct SensorExpectation {
  double min_elevation_rad = -15.0 * M_PI / 180.0;  ///< The lidar's field of view: lowest row...
  double max_elevation_rad = 15.0 * M_PI / 180.0;   ///< ...and highest, evenly spaced between.
  double max_azimuth_rad = M_PI;                    ///< To both sides of the lidar's x axis.
  int num_rows = 16;                                ///< At most kMaxRings.
  double column_step_rad = 0.2 * M_PI / 180.0;      ///< From return to return of a row.
  double corner_noise_px = 0.1;  ///< 1 sigma of a chessboard corner in each direction.
  LidarBoardOptions detector;    ///< How it sees edges.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;

  double RowStepRad() const { return (max_elevation_rad - min_elevation_rad) / (num_rows - 1); }
};

/// Of the returns on a board, one in so many is made: as much is known from fewer if their noise is
/// smaller by the root of it.
inline constexpr int kExpectedThinning = 4;

/// What the detectors are expected to say of a board, without noise. Covariances:
/// - camera: s^2 (J' J)^-1 of the inner corners, J = d pixel / d [rotation; translation], s the
///   corners' noise;
/// - lidar, in the board's plane: (P + sum of g g' / s^2)^-1 over both ends of each row on the
///   board, of [x; y; turn; spill; thickness], the last two with the detector's priors P (see
///   OutlineModel). An end tells where the edge is that it lies on, along the edge's outward normal
///   e:
///       g = [e; p x e; 1; max(-e . lean, 0)],   s^2 = (e . u)^2 spacing (blur + spacing / 12)
///   u the row's direction in the plane: beams that turn from hit to miss by a logistic of scale
///   blur tell its place to spacing blur, if they are dense; if not, to their spacing / sqrt(12).
///   The plane itself is left to the returns.
/// Rows are the rings, the lowest 0. A row with fewer than two returns is left out.
BoardSample ExpectedSample(const Eigen::Isometry3d& T_camera_board,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const SensorExpectation& expectation);

}  // namespace voqcal
