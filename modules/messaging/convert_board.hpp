#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/sampling/sample_picker.hpp"
#include "voqcal/board_pose_t.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/lidar_candidate_t.hpp"
#include "voqcal/sample_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

// Both ways are exact: a detection that went through a message (or a log) is the same to the last
// bit, so that one process and many give the same extrinsic. Only the points' times are not
// carried.

board_pose_t ToMessage(const BoardPose& pose);
BoardPose FromMessage(const board_pose_t& message);

lidar_candidate_t ToMessage(const LidarBoard& board);
/// @throws MessageError if the counts of points and rings contradict each other.
LidarBoard FromMessage(const lidar_candidate_t& message);

/// With utime and seq 0, as a sample holds it.
camera_board_t ToMessage(const CameraBoard& board);
CameraBoard FromMessage(const camera_board_t& message);

/// What the lidar detector found in one sweep.
/// @param candidates  best first; if there is no board, what may be it, but may be something else.
/// @param miss        why there is none; empty if there is one.
/// @param accumulated_us  how much older the oldest returns are that they are from.
lidar_board_t LidarBoardMessage(const std::vector<LidarBoard>& candidates,
                                const std::string& miss,
                                std::int64_t utime,
                                std::int64_t accumulated_us,
                                std::int64_t seq);
/// What the camera detector found in one image; no board needs a `miss`, and may have a `detail` of
/// it.
camera_board_t CameraBoardMessage(const std::optional<CameraBoard>& board,
                                  const std::string& miss,
                                  const std::string& detail,
                                  std::int64_t utime,
                                  std::int64_t seq);

/// For the sample picker: the candidates, or the reason for none.
LidarSighting SightingFromMessage(const lidar_board_t& message);
CameraSighting SightingFromMessage(const camera_board_t& message);

sample_t ToMessage(const BoardSample& sample);
BoardSample FromMessage(const sample_t& message);

/// @param log_sha256  of the session's samples.lcm, which holds the same samples.
samples_t ToMessage(const std::vector<BoardSample>& samples,
                    std::int64_t revision,
                    bool is_finished,
                    const std::string& log_sha256);
std::vector<BoardSample> FromMessage(const samples_t& message);

}  // namespace voqcal
