#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/board/board_sample.hpp"
#include "messaging/convert_board.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/lidar_board_t.hpp"

namespace voqcal::test {

/// What both detectors say at one instant.
struct SightingMessages {
  lidar_board_t lidar;
  camera_board_t camera;
};

/// Four frames, 0.1 s apart, of a board that rests where samples[stop] has it: three make a sample,
/// by the sample picker's defaults, and the last shows that the third's time is over. It shows no
/// board. Numbered so that stops 0, 1, ... in a row have no gap.
inline std::vector<SightingMessages> StillFrames(const std::vector<BoardSample>& samples,
                                                 int stop) {
  const BoardSample& sample = samples[static_cast<std::size_t>(stop)];
  std::vector<SightingMessages> frames;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t utime = sample.utime + i * 100'000;
    const std::int64_t seq = 4 * stop + i;
    if (i < 3) {
      frames.push_back({LidarBoardMessage({sample.lidar}, "", utime, 0, seq),
                        CameraBoardMessage(sample.camera, "", "", utime, seq)});
    } else {
      frames.push_back({LidarBoardMessage({}, "no plane", utime, 0, seq),
                        CameraBoardMessage(std::nullopt, "no board", "", utime, seq)});
    }
  }
  return frames;
}

}  // namespace voqcal::test
