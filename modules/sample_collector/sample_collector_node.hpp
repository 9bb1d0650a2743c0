#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/sampling/sample_picker.hpp"
#include "health/heartbeats.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "sample_collector/clock_watch.hpp"
#include "sample_collector/miss_examples.hpp"
#include "sample_collector/second_look.hpp"
#include "sample_collector/session_log.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/lidar_board_t.hpp"

namespace voqcal {

/// LIDAR_BOARD, CAMERA_BOARD and CALIB_COMMAND in, CALIB_SAMPLES and CALIB_EVENT out. Accepted
/// samples are on the disk before they are announced, each with its scene: the LIDAR_POINTS and
/// CAMERA_IMAGE of its first frame. A node made again on the same session goes on.
class SampleCollectorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  /// @throws std::runtime_error if the session's log cannot be made or read.
  SampleCollectorNode(const Rig& rig, Bus* bus, const std::filesystem::path& session_folder);

  std::string Name() const override { return "sample_collector"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

  /// Takes a sample that another program extracted; it has no scene.
  void Accept(const BoardSample& sample) { Accept(sample, {}, ""); }

  /// No more frames will come: judges what waits, looks again where the lidar was unsure, and says
  /// so in CALIB_SAMPLES. The command "finish" does the same once no frame has come for a second,
  /// since detectors may still be at work. Where a sensor goes on, it is done once its detector is
  /// past the frames that had come before it, and later frames give no sample until the command
  /// "capture" or "reset".
  void Finish();

  const std::vector<BoardSample>& samples() const { return session_.samples(); }
  /// Of sweeps and images that a sample may still be made of.
  std::size_t NumFrameBytes() const {
    return lidar_.frames.num_bytes() + camera_.frames.num_bytes();
  }

 private:
  /// What is heard of one sensor.
  struct Stream {
    FrameBuffer frames;
    std::int64_t board_utime = std::numeric_limits<std::int64_t>::min();  ///< Newest, or a miss.
    bool has_new_frames = false;                                          ///< Since Republish...
    bool has_new_boards = false;                                          ///< ...was called last.
  };

  static void Keep(SensorFrame frame, Stream* stream);
  template <typename BoardMessage>
  void OnBoard(const BoardMessage& message, Stream* stream);
  /// Another session's detectors may say what this one's cannot be told from.
  bool IsNetworkShared() const;
  void NoteMiss(const lidar_board_t& message);
  void NoteMiss(const camera_board_t& message);
  /// Where there are too few samples for a result, what was seen instead.
  void SaveMisses() const;
  void OnCommand(const command_t& message);
  void Discard(const command_t& message);
  void RequestFinish();
  /// A frame that came after "finish" was asked for.
  bool IsTooLate(std::int64_t utime) const;
  void GoOn();  ///< After "finish".
  /// Nothing of what had come when "finish" was asked for is still to be judged.
  bool IsAllJudged() const;
  /// Its detector is past that, or nothing comes of it any more.
  bool IsJudged(const Stream& stream) const;
  void SayFinished();
  void Reset(std::int64_t utime);
  void CancelCapture();
  void Accept(const BoardSample& sample, const SampleScene& scene, const std::string& remark);
  /// Into the sweeps of stops that the lidar alone was unsure of, as far as the samples and these
  /// stops now tell where to look. `is_resting`: the board may still be at the newest of them,
  /// where the lidar may yet see it by itself.
  void LookAgain(bool is_resting);
  /// As the session goes: whenever there is half as much again to tell where to look.
  void LookAgainIfDue();
  /// With what was seen at its first frame, if both frames are at hand. The first sample after the
  /// command "capture" is the captured one (SamplePicker::RequestCapture).
  void AcceptWithScene(const BoardSample& sample);
  void Decide(const std::vector<PickerDecision>& decisions);
  void Announce(std::int64_t utime,
                const std::string& kind,
                std::int64_t sample_id,
                const std::string& reason);
  void PublishSamples();

  Channels channels_;
  std::string pair_;  ///< Which commands are meant for it.
  Bus& bus_;
  std::filesystem::path session_folder_;
  SamplePicker picker_;
  Stream lidar_;
  Stream camera_;
  ClockWatch clocks_;
  Heartbeats heartbeats_;
  MissExamples misses_;
  SecondLook second_look_;
  std::size_t next_look_;  // at so many samples and kept stops
  SessionLog session_;
  std::string log_sha256_;
  std::int64_t event_seq_ = 0;
  bool is_capture_requested_ = false;  // by command: the next sample will be that
  bool is_finish_requested_ = false;
  std::optional<std::int64_t> finish_utime_;  // of the newest frame when that was; if one had come
  bool is_finished_ = false;
  bool was_idle_ = false;  // since the last Republish: no message waited
};

}  // namespace voqcal
