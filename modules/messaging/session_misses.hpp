#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voqcal/camera_board_t.hpp"
#include "voqcal/counter_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {

/// Name of the log of frames without a board in a session's folder. It is there where "finish" left
/// too few samples for a result.
inline constexpr char kMissesLogName[] = "misses.lcm";

/// Its channels: first the counts, then frames, each with what its detector said of it behind it.
inline constexpr char kMissCountsChannel[] = "MISS_COUNTS";  ///< module_status_t
inline constexpr char kMissSweepChannel[] = "MISS_SWEEP";    ///< pointcloud2_t
inline constexpr char kMissImageChannel[] = "MISS_IMAGE";    ///< image_t
inline constexpr char kLidarMissChannel[] = "LIDAR_MISS";    ///< lidar_board_t
inline constexpr char kCameraMissChannel[] = "CAMERA_MISS";  ///< camera_board_t

struct SweepMiss {
  pointcloud2_t sweep;
  lidar_board_t board;
};

struct ImageMiss {
  image_t image;
  camera_board_t board;
};

/// A few frames of each reason for which no board was found in them.
struct SessionMisses {
  /// "LIDAR_MISS: joined to something below", "CAMERA_MISS: no board", and those of the sample
  /// collector: how often.
  std::vector<counter_t> counts;
  std::string trouble;  ///< Of the sample collector's state: the clocks differ, say.
  std::vector<SweepMiss> sweeps;
  std::vector<ImageMiss> images;
};

/// @return nothing in it if there is no such log; what comes before damage if there is.
SessionMisses ReadMisses(const std::filesystem::path& session_folder);

}  // namespace voqcal
