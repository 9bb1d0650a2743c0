#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// A box in the lidar frame, metres: the board is searched inside. Points outside only show where
/// it ends.
struct RegionOfInterest {
  Eigen::Vector3d min_lidar_m = Eigen::Vector3d::Constant(-1e9);
  Eigen::Vector3d max_lidar_m = Eigen::Vector3d::Constant(1e9);
};

/// How the lidar board detector searches one cloud.
struct LidarBoardOptions {
  double min_range_m = 0.5;   ///< Nearer returns are the robot itself.
  double max_range_m = 12.0;  ///< Farther boards have too few points to measure.
  std::optional<RegionOfInterest> region_of_interest;  ///< Not needed; narrows the search.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Why a sweep shows no board.
enum class LidarBoardMiss {
  kTooFewPoints,  ///< The cloud (or the region of interest) is all but empty.
  kNoPlane,       ///< No planar patch of about the board's size.
  kSizeMismatch,  ///< Planar patches, but none whose outline fits the board's size.
  kOutlineOpen,   ///< A patch fits, but on one side nothing shows where it ends.
  kAmbiguous,     ///< Two patches fit equally well.
};

std::string ToString(LidarBoardMiss miss);  ///< "too few points", ... as MODULE_STATUS counts them.

/// Finds the board of known size in one whole sweep: no region of interest, rings or order of
/// points needed.
///
/// @return candidates, best first, never empty; or why there is none: an empty view is an ordinary
///     answer, not an error.
/// @throws std::invalid_argument if `board` or `options` have Problems().
Expected<std::vector<LidarBoard>, LidarBoardMiss> DetectLidarBoard(
    const PointCloud& cloud_lidar_m, const BoardSpec& board, const LidarBoardOptions& options);

}  // namespace voqcal
