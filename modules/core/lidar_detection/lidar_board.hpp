#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/lidar_background.hpp"
#include "core/lidar_detection/lidar_board_miss.hpp"

namespace voqcal {

/// A box in the lidar frame, metres: the board is searched inside. Points outside only show where
/// it ends.
struct RegionOfInterest {
  Eigen::Vector3d min_lidar_m = Eigen::Vector3d::Constant(-1e9);
  Eigen::Vector3d max_lidar_m = Eigen::Vector3d::Constant(1e9);
};

/// How the lidar sees a plate. Across the beam, measured on 30 sweeps of a VLP-16 (1.7 to 3.2 m):
/// hits end 5 mm past the edge whatever the range, and beams turn from hit to miss within 3 to
/// 4 mm. Doubling or halving any of these moves the centres by less than 1 mm.
struct LidarBeamOptions {
  double spill_m = 0.005;        ///< Hits end so far past an edge...
  double spill_sigma_m = 0.004;  ///< ...give or take (1 sigma).
  double blur_m = 0.002;         ///< Scale of a beam's turn from hit to miss, at no range...
  double blur_per_m = 0.0005;    ///< ...and its growth with the range.
  /// Returns so far before or behind the plane are of the board. Scan lines of one lidar differ by
  /// up to 30 mm and dark from bright squares by 15 mm, both on top of 10 mm of noise (1 sigma).
  double hit_band_m = 0.05;
  double line_sigma_m = 0.008;  ///< Offset of one scan line (laser) from the others, 1 sigma.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// How the lidar board detector searches one cloud.
struct LidarBoardOptions {
  double min_range_m = 0.5;   ///< Nearer returns are the robot itself.
  double max_range_m = 20.0;  ///< Farther boards have too few points to measure.
  std::optional<RegionOfInterest> region_of_interest;  ///< Not needed; narrows the search.
  double max_corner_sigma_m = 0.04;  ///< A board whose outline is less certain is refused.
  double max_bend_m = 0.02;          ///< A board that is certainly more bent is refused.
  double thickness_m = 0.01;  ///< Of the board: a plate has a few millimetres, foam 20 or so...
  double thickness_sigma_m = 0.01;  ///< ...and how little is known of it (1 sigma).
  /// Where one sweep is too thin to tell, sweeps of so long are put together while the board rests;
  /// 0: none.
  double max_accumulation_s = 1.0;
  LidarBeamOptions beam;
  LidarBackgroundOptions background;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Where the board is expected: a camera's sighting of it and a rough extrinsic tell.
struct BoardPrior {
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (lidar) side at the board's centre.
  Matrix6d covariance = Matrix6d::Zero();

  /// One line for each broken constraint, with its value; empty if the prior is usable.
  std::vector<std::string> Problems() const;
};

/// Finds the board of known size in one whole sweep: no region of interest, rings or order of
/// points needed.
///
/// The lidar's frame may be turned anyhow. Scan lines that the sweep does not name are told from
/// its geometry.
///
/// Without a prior a board counts as found only if its measured sides tell it from other things;
/// what may be the board, but may be something else, is in the error's `unsure`, best first. With a
/// prior the board is searched there alone (within three sigma), which side is which is known, and
/// its outline may be as incomplete as the sweep leaves it. The prior chooses, and holds the board
/// along what no side tells; it adds nothing to the pose's covariance.
///
/// @param background  of earlier sweeps; null if there are none. What came since they were learned
///     ranks higher, by up to twice its likelihood; poses do not depend on it.
/// @return candidates, best first, never empty; or why there is none: an empty view is an ordinary
///     answer, not an error.
/// @throws std::invalid_argument if `board`, `options` or `prior` have Problems().
Expected<std::vector<LidarBoard>, NoLidarBoard> DetectLidarBoard(
    const PointCloud& sweep_lidar_m,
    const BoardSpec& board,
    const LidarBoardOptions& options,
    const LidarBackground* background = nullptr,
    const std::optional<BoardPrior>& prior = {});

}  // namespace voqcal
