#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/detected_boards.hpp"
#include "calibrate/picture_grounds.hpp"
#include "calibrate/recording_clocks.hpp"
#include "camera_board_detector/camera_board_detector_node.hpp"
#include "lidar_board_detector/lidar_board_detector_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/log.hpp"
#include "rig/rig.hpp"
#include "rig_calibrator/pair_chain.hpp"
#include "sample_collector/sample_collector_node.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"

namespace voqcal {

/// What feeding a log is to the caller: called now and then with the share done and the samples so
/// far.
using OnProgress = std::function<void(double share, std::size_t num_samples)>;

/// What the detectors of a lidar and a camera made of a recording; nothing: they run themselves.
struct BoardsOfPair {
  const DetectedBoards* lidar = nullptr;
  const DetectedBoards* camera = nullptr;
};

/// The live system's modules on one in-process bus: the same input gives the same bytes as the live
/// processes, faster.
class OfflineRun {
 public:
  /// @param session_folder  where samples.lcm and extrinsic.yaml go.
  /// @param boards  what the detectors made of the recording already; borrowed.
  OfflineRun(const Rig& rig,
             const std::filesystem::path& session_folder,
             const BoardsOfPair& boards = {});

  /// Feeds the sensor messages of a recording (sweeps, images, commands), event by event.
  /// An event that is cut off by the file's end is left out, with a warning. What `times` comes to
  /// is said if it is not the stamps.
  /// @throws std::runtime_error naming the log, byte or event, and the cause.
  void FeedLog(const std::filesystem::path& log,
               const OnProgress& on_progress,
               RecordingTimes times = RecordingTimes::kAuto);

  /// Feeds samples that another program extracted.
  void FeedSamples(const std::vector<BoardSample>& samples);

  /// Judges the last frames; then, unless `is_collecting_only`, estimates, refines and assesses.
  void Finish(bool is_collecting_only);

  const std::vector<BoardSample>& samples() const { return collector_.samples(); }
  /// The samples, each with the lidar's candidate that was chosen for it.
  std::vector<BoardSample> SamplesAsChosen() const;
  const AssessorNode& assessor() const { return chain_.assessor(); }
  /// Of the samples that were used, after Finish.
  const KeptGrounds& grounds() const { return grounds_; }
  /// The newest EXTRINSIC_AVERAGED: the chosen sets and what each gave.
  const extrinsic_averaged_t& averaged() const { return averaged_; }
  /// Every CALIB_EVENT.
  const std::vector<event_t>& events() const { return events_; }

  /// "LIDAR_POINTS: 3 lost, 0 unreadable; 1 damaged places; cut off ...": what the recording lacks,
  /// by its sequence numbers and as it was read; empty if nothing.
  std::string Losses() const;

  /// What each module counted, by module: boards, misses by reason, samples, rejections by reason.
  std::vector<const Module*> modules() const;

 private:
  bool UsesLogTimes(const std::filesystem::path& log, RecordingTimes times) const;
  std::optional<LogEvent> NextBeforeCut(LogReader* reader);
  void Feed(const LogEvent& event, std::int64_t end_of_event);
  void HandleAll();

  Channels channels_;
  Bus bus_;
  BoardsOfPair boards_;
  std::optional<LidarBoardDetectorNode> lidar_detector_;
  std::optional<CameraBoardDetectorNode> camera_detector_;
  SampleCollectorNode collector_;
  KeptGrounds grounds_;
  PairChain chain_;
  extrinsic_averaged_t averaged_;
  std::vector<event_t> events_;
  std::int64_t num_damaged_ = 0;    // places of the recording
  std::int64_t num_cut_bytes_ = 0;  // of the event that its end cut off
};

/// True if the log is a session's samples.lcm rather than a recording of sensors.
/// @throws std::runtime_error naming the log and the cause if it cannot be read.
bool IsSamplesLog(const Rig& rig, const std::filesystem::path& log);

}  // namespace voqcal
