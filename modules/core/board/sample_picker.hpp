#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// When a pair of sightings becomes a sample.
struct SamplePickerOptions {
  double max_pair_offset_s = 0.06;    ///< Lidar and camera frames of one pair are at most this far apart.
  int num_still_frames = 3;           ///< Consecutive pairs over which the board must be still.
  double max_still_motion_m = 0.02;   ///< Centre movement over these pairs, by the lidar.
  double max_still_motion_px = 1.0;   ///< Largest corner movement over these pairs, by the camera.
  double min_new_distance_m = 0.05;   ///< A pose is new if its centre is this far from every sample's...
  double min_new_angle_rad = 0.05;    ///< ...or its orientation differs by this much.
  double max_edge_error_m = 0.10;     ///< Largest error of one measured edge length.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// One frame of the lidar board detector: a board, or the reason for none.
struct LidarSighting {
  std::int64_t utime = 0;
  std::optional<LidarBoard> board;
  std::string miss;
};

/// One frame of the camera board detector.
struct CameraSighting {
  std::int64_t utime = 0;
  std::optional<CameraBoard> board;
  std::string miss;
};

/// One decision: a sample, or why a pair gave none.
struct PickerDecision {
  std::int64_t utime = 0;  ///< Of the lidar frame, or the camera frame if it has no partner.
  std::optional<BoardSample> accepted;
  std::string reason;      ///< Empty if accepted.
};

/// Pairs the two detectors' streams by sensor time and picks the samples.
///
/// The answer depends on the sightings' times only, not on the order in which they arrive between the
/// streams: a sighting is judged once both streams have passed its time (or at Flush).
class SamplePicker {
 public:
  SamplePicker(const BoardSpec& board, const SamplePickerOptions& options);

  /// Sightings of one stream come in order of time; a late one is answered with a rejection.
  std::vector<PickerDecision> Add(const LidarSighting& sighting);
  std::vector<PickerDecision> Add(const CameraSighting& sighting);

  /// No more frames will come: judges what waits.
  std::vector<PickerDecision> Flush();

  /// Takes the next usable pair even if the board moves or the pose is not new.
  void RequestCapture() { is_capture_requested_ = true; }

  /// The samples that a session already has: new poses must differ from them.
  void SetKnown(const std::vector<BoardSample>& samples);

 private:
  BoardSpec board_;
  SamplePickerOptions options_;
  bool is_capture_requested_ = false;
  std::deque<LidarSighting> lidar_;
  std::deque<CameraSighting> camera_;
};

}  // namespace voqcal
