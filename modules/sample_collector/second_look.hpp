#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/sampling/sample_picker.hpp"
#include "core/selection/extrinsic_vote.hpp"
#include "rig/rig.hpp"
#include "sample_collector/frame_buffer.hpp"

namespace voqcal {

/// A stop of the board that the lidar alone was unsure of, with its frames.
struct KeptStop {
  UnsureStop stop;
  std::vector<SensorFrame> sweeps;   ///< Encoded pointcloud2_t, one for each of the stop's frames.
  std::optional<SensorFrame> image;  ///< Of the first frame.
};

/// Looks again into sweeps in which the lidar alone was unsure, where the camera's board says,
/// once a few stops agree on a rough extrinsic.
class SecondLook {
 public:
  explicit SecondLook(const Rig& rig) : rig_(rig) {}

  /// Keeps a stop for later. False if there is no room for its sweeps, or one is missing.
  bool Keep(UnsureStop stop, const FrameBuffer& sweeps, const FrameBuffer& images);

  void Clear();

  /// @param is_newest_spared  the newest kept stop is not looked at.
  /// @return the kept stops in whose every sweep the board is where `samples` and the kept stops
  ///     together make the camera's board expect it; they are kept no longer. Those that were
  ///     looked at in vain, or could not be for want of a rough extrinsic, stay, and their reasons
  ///     are in `misses`.
  std::vector<KeptStop> FindBoards(const std::vector<BoardSample>& samples,
                                   bool is_newest_spared,
                                   std::vector<std::string>* misses);

  bool empty() const { return kept_.empty(); }
  std::size_t size() const { return kept_.size(); }

 private:
  std::string FindBoard(const RoughExtrinsic& extrinsic, KeptStop* kept) const;

  Rig rig_;
  std::vector<KeptStop> kept_;
  std::size_t num_bytes_ = 0;
};

}  // namespace voqcal
