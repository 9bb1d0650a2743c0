#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/board/board_spec.hpp"
#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/lidar_detection/lidar_board.hpp"

namespace voqcal {

/// What a stream of sweeps shows at the time of its newest.
struct LidarBoardSighting {
  Expected<std::vector<LidarBoard>, NoLidarBoard> boards;
  /// How long before it the oldest sweep is whose returns they are: the board has rested since
  /// then.
  std::int64_t accumulated_us = 0;
};

/// Finds the board in a stream of sweeps: in the newest alone or, where that is too thin to show a
/// whole one, in those of the last `max_accumulation_s` put together; where these show none, in the
/// newer half of them, and so on: the board may have come to rest only then.
///
/// Only sweeps that look elsewhere each time fill each other's gaps. Of a direction's returns the
/// newest counts: more of the same beam say nothing of where the board ends, and what all of them
/// share does not average out. A lidar that repeats its beams is never accumulated.
///
/// A board that moved meanwhile is refused: the older and the newer half of the sweeps must see it
/// at the same place, as far as they can tell.
class AccumulatingDetector {
 public:
  /// @throws std::invalid_argument if `board` or `options` have Problems().
  AccumulatingDetector(const BoardSpec& board, const LidarBoardOptions& options);

  /// @param utime  of the sweep, microseconds; one that is not after the last begins anew.
  /// @param background  as DetectLidarBoard takes it.
  LidarBoardSighting Detect(const PointCloud& sweep_lidar_m,
                            std::int64_t utime,
                            const LidarBackground* background = nullptr);

  /// Whether the lidar sends the same beams each time; nothing before two sweeps that tell.
  std::optional<bool> is_repeating() const { return is_repeating_; }

 private:
  struct Sweep {
    std::int64_t utime = 0;
    PointCloud cloud_lidar_m;
    std::vector<std::uint32_t> cells;  ///< In whose direction each point lies.
  };

  void Keep(const PointCloud& sweep_lidar_m, std::int64_t utime);
  /// Tells by the two newest sweeps whether the lidar repeats its beams.
  void TellWhetherRepeating();
  PointCloud Accumulated(std::size_t first, std::size_t last) const;
  /// Whether the older and the newer half of the sweeps from `first` on see it at the same place.
  bool Rests(const LidarBoard& found, std::size_t first) const;

  BoardSpec board_;
  LidarBoardOptions options_;
  std::deque<Sweep> sweeps_;  // oldest first
  std::optional<bool> is_repeating_;
};

}  // namespace voqcal
