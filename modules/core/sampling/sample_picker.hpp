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
  double max_pair_offset_s =
      0.06;                  ///< Lidar and camera frames of a pair are at most this far apart.
  int num_still_frames = 3;  ///< Consecutive pairs over which the board must be still.
  double max_still_motion_m = 0.02;  ///< Centre movement over these pairs, by the lidar.
  double max_still_motion_px = 1.0;  ///< Largest corner movement over these pairs, by the camera.
  double min_new_distance_m =
      0.05;  ///< A pose is new if its centre is this far from every sample's...
  double min_new_angle_rad = 0.05;  ///< ...or its orientation differs by this much.
  double max_edge_error_m = 0.15;   ///< Largest error of one measured edge length.
  int max_candidates = 3;           ///< Of the lidar, kept with a sample; the others' poses tell.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// One frame of a board detector: a board, or the reason for none.
template <typename Board>
struct Sighting {
  std::int64_t utime = 0;
  std::optional<Board> board;
  std::string miss;
  std::vector<Board> runners_up{};  ///< Others that might be the board, best first (lidar only).
  /// Where there is no board: what may be it, but may be something else (lidar only).
  std::vector<Board> unsure{};
  /// How long before utime the oldest sweep is that the board is from (lidar only).
  std::int64_t accumulated_us = 0;
};
using LidarSighting = Sighting<LidarBoard>;
using CameraSighting = Sighting<CameraBoard>;

/// A stop of the board that the camera saw, and the lidar by itself did not: once the extrinsic is
/// known roughly, a second look tells.
struct UnsureStop {
  std::vector<LidarSighting> lidar;    ///< Of num_still_frames frames, in order of time...
  std::vector<CameraSighting> camera;  ///< ...and of the images paired with them.
};

/// One decision: a sample, or why a pair of frames gave none.
struct PickerDecision {
  std::int64_t utime = 0;  ///< Of the lidar frame, or of the camera frame that has none.
  std::optional<BoardSample> accepted;  ///< Its id is 0: numbering is the caller's.
  std::string reason;                   ///< Empty if accepted; one of a few, to be counted.
  std::string detail{};                 ///< What there is to add to the reason; often empty.
  std::optional<UnsureStop> unsure{};   ///< With the reason that the lidar saw no board.
};

/// Capture times of frames.
struct FramesInUse {
  std::vector<std::int64_t> lidar_utimes;
  std::vector<std::int64_t> camera_utimes;
};

/// Pairs the two detectors' streams by sensor time and picks the samples.
///
/// The answer depends on the sightings' times only, not on the order in which the two streams
/// arrive: a sighting is judged once both streams have passed its time, or at Flush. Three
/// exceptions: a stream whose partner lags by more than 600 frames is judged without it;
/// RequestCapture takes the next pair that is judged after the request; and where a stream goes
/// back by more than 2 s (its driver was started again on a recording), all that waits is judged
/// and time begins anew.
class SamplePicker {
 public:
  /// @throws std::invalid_argument if `options` have Problems().
  SamplePicker(const BoardSpec& board, const SamplePickerOptions& options);

  /// Sightings of one stream come in order of time; a late one is answered with a rejection.
  std::vector<PickerDecision> Add(const LidarSighting& sighting);
  std::vector<PickerDecision> Add(const CameraSighting& sighting);

  /// No more frames will come: judges what waits.
  std::vector<PickerDecision> Flush();

  /// Takes the next pair with a board in both, even if it moves or the pose is not new.
  void RequestCapture() { is_capture_requested_ = true; }
  /// Takes that back, if the pair has not come.
  void CancelCapture() { is_capture_requested_ = false; }

  /// A sample of a stop in which the lidar's board was found since, each frame's sighting with it.
  /// The stop is unsure no more: if its sample is discarded, the board may come back there.
  PickerDecision TakeStop(const UnsureStop& stop);

  /// Those that were added and that a later decision may name; it names no others.
  FramesInUse InUse() const;

  /// The samples that the session has: new poses must differ from them. Unsure stops stay, as
  /// whoever keeps them does: the same stop must not come twice.
  void SetKnown(const std::vector<BoardSample>& samples);
  /// Forgets samples, unsure stops and what waits: a sample of the new session is made of
  /// sightings that come from now on.
  void StartAnew();

 private:
  struct Pair {
    LidarSighting lidar;
    CameraSighting camera;
  };

  std::vector<PickerDecision> RestartIfBack(std::int64_t utime, std::int64_t newest);
  std::vector<PickerDecision> Judge(bool is_flushing);
  void ForgetWaiting();
  /// Index in camera_ of the frame nearest to `utime` within max_pair_offset_s; -1 if there is
  /// none.
  int NearestCameraFrame(std::int64_t utime) const;
  /// Takes the oldest camera frame away: no lidar frame can claim it.
  PickerDecision DropCameraFrame();
  PickerDecision JudgePair(Pair pair);
  PickerDecision JudgeWindow(const std::vector<Pair>& window);
  /// What the lidar saw resting through all frames of a window: the likeliest, then the others.
  std::vector<LidarBoard> RestingCandidates(const std::vector<Pair>& window) const;
  /// Keeps `followed_` and `rest_begin_` up.
  void FollowCamera(const Pair& pair);
  /// What is followed, if it is whole and its pose is new.
  std::optional<UnsureStop> FollowedStop();
  BoardSample MakeSample(std::vector<LidarBoard> candidates,
                         const std::vector<CameraBoard>& camera,
                         std::int64_t utime) const;
  /// Whether the camera's board has been at rest since the oldest sweep that the lidar's is from.
  bool HasRestedThrough(const LidarSighting& lidar) const;
  /// Why the window's boards are not at rest; empty if they are.
  std::string Motion(const Pair& pair) const;
  bool IsNew(const BoardPose& pose_camera) const;
  void ForgetUnsure(const BoardPose& pose_camera);

  BoardSpec board_;
  SamplePickerOptions options_;
  std::int64_t max_pair_offset_us_;
  bool is_capture_requested_ = false;
  std::deque<LidarSighting> lidar_;    // not yet judged, in order of time
  std::deque<CameraSighting> camera_;  // not yet judged, in order of time
  std::int64_t newest_lidar_utime_;
  std::int64_t newest_camera_utime_;
  std::vector<Pair> window_;    // the latest consecutive pairs with a resting board
  std::vector<Pair> followed_;  // those in which the camera's board rests, whatever the lidar saw
  std::optional<CameraSighting> rest_begin_;  // the first that the camera's board rests since
  std::vector<Eigen::Isometry3d> known_T_camera_board_;
  std::vector<Eigen::Isometry3d> unsure_T_camera_board_;  // of the unsure stops so far
};

}  // namespace voqcal
