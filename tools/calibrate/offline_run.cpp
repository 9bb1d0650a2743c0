#include "calibrate/offline_run.hpp"

#include <chrono>
#include <exception>
#include <set>
#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "messaging/convert_result.hpp"
#include "messaging/log.hpp"
#include "sample_collector/session_log.hpp"

namespace voqcal {
namespace {

/// None where the boards are known.
template <typename Detector>
std::optional<Detector> DetectorUnless(const DetectedBoards* boards, const Rig& rig, Bus* bus) {
  if (boards != nullptr) return std::nullopt;
  return std::optional<Detector>(std::in_place, rig, bus);
}

}  // namespace

OfflineRun::OfflineRun(const Rig& rig,
                       const std::filesystem::path& session_folder,
                       const BoardsOfPair& boards)
    : channels_(rig.channels),
      bus_("memq://"),
      boards_(boards),
      lidar_detector_(DetectorUnless<LidarBoardDetectorNode>(boards.lidar, rig, &bus_)),
      camera_detector_(DetectorUnless<CameraBoardDetectorNode>(boards.camera, rig, &bus_)),
      collector_(rig, &bus_, session_folder),
      grounds_(rig.camera),
      chain_(
          rig,
          &bus_,
          session_folder,
          [this](const BoardSample& sample, const cv::Mat& image) { grounds_.Add(sample, image); }),
      averaged_{} {
  bus_.Subscribe<extrinsic_averaged_t>(channels_.extrinsic_averaged,
                                       Queue::kState,
                                       [this](const extrinsic_averaged_t& m) { averaged_ = m; });
  bus_.Subscribe<event_t>(
      channels_.calib_event, Queue::kEvery, [this](const event_t& m) { events_.push_back(m); });
}

void OfflineRun::FeedLog(const std::filesystem::path& log,
                         const OnProgress& on_progress,
                         RecordingTimes times) {
  const bool use_log_times = UsesLogTimes(log, times);
  const std::set<std::string> inputs = {
      channels_.lidar_points, channels_.camera_image, channels_.calib_command};
  std::set<std::string> seen;
  LogReader reader(log);
  while (std::optional<LogEvent> event = NextBeforeCut(&reader)) {
    seen.insert(event->channel);
    if (inputs.count(event->channel) == 0) continue;
    if (use_log_times && event->channel != channels_.calib_command) TakeLogTime(&*event);
    try {
      Feed(*event, reader.offset());
    } catch (const std::exception& error) {
      throw std::runtime_error(log.string() + ": event " + std::to_string(event->number) + " (" +
                               event->channel + "): " + error.what());
    }
    on_progress(static_cast<double>(reader.offset()) / static_cast<double>(reader.num_bytes()),
                samples().size());
  }
  num_damaged_ += reader.num_damaged();
  for (const std::string& needed : {channels_.lidar_points, channels_.camera_image}) {
    if (seen.count(needed) != 0) continue;
    std::string there;
    for (const std::string& channel : seen) there += (there.empty() ? "" : ", ") + channel;
    throw std::runtime_error(log.string() + ": has no channel " + needed + "; it has " +
                             (there.empty() ? "no events"
                                            : there + " (a lidar's packets and types of your own "
                                                      "are read by --bag)"));
  }
}

void OfflineRun::Feed(const LogEvent& event, std::int64_t end_of_event) {
  const auto publish = [this](const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    bus_.PublishBytes(channel, bytes.data(), bytes.size());
    HandleAll();
  };
  publish(event.channel, event.bytes);
  if (boards_.lidar != nullptr && event.channel == channels_.lidar_points) {
    for (const auto& bytes : boards_.lidar->Of(end_of_event)) publish(channels_.lidar_board, bytes);
  }
  if (boards_.camera != nullptr && event.channel == channels_.camera_image) {
    for (const auto& bytes : boards_.camera->Of(end_of_event)) {
      publish(channels_.camera_board, bytes);
    }
  }
}

bool OfflineRun::UsesLogTimes(const std::filesystem::path& log, RecordingTimes times) const {
  if (times != RecordingTimes::kAuto) return times == RecordingTimes::kLog;
  const ClockVerdict verdict = JudgeClocksOf(log, channels_);
  if (!verdict.words.empty()) spdlog::warn("{}: {}", log.string(), verdict.words);
  return verdict.use_log_times;
}

// A power failure or a full disk ends a recording within an event: what came before it is good.
std::optional<LogEvent> OfflineRun::NextBeforeCut(LogReader* reader) {
  try {
    return reader->Next();
  } catch (const TruncatedLogError& error) {
    num_cut_bytes_ = reader->num_bytes() - error.offset();
    spdlog::warn(
        "{}: its {} bytes are left out, all before it is used", error.what(), num_cut_bytes_);
    return std::nullopt;
  }
}

void OfflineRun::FeedSamples(const std::vector<BoardSample>& samples) {
  for (const BoardSample& sample : samples) collector_.Accept(sample);
}

void OfflineRun::Finish(bool is_collecting_only) {
  collector_.Finish();
  HandleAll();
  if (!is_collecting_only) chain_.Run();
}

std::vector<BoardSample> OfflineRun::SamplesAsChosen() const {
  std::vector<BoardSample> as_chosen = samples();
  TakeChosen(averaged_.chosen, &as_chosen);
  return as_chosen;
}

std::string OfflineRun::Losses() const {
  std::string text;
  for (const auto& [channel, counts] : bus_.channels()) {
    if (counts.num_lost == 0 && counts.num_malformed == 0) continue;
    text += (text.empty() ? "" : "; ") + channel + ": " + std::to_string(counts.num_lost) +
            " lost, " + std::to_string(counts.num_malformed) + " unreadable";
  }
  if (num_damaged_ > 0) {
    text += (text.empty() ? "" : "; ") + std::to_string(num_damaged_) + " damaged places";
  }
  if (num_cut_bytes_ > 0) {
    text += (text.empty() ? "" : "; ") + std::string("cut off within an event, ") +
            std::to_string(num_cut_bytes_) + " bytes left out";
  }
  return text;
}

std::vector<const Module*> OfflineRun::modules() const {
  std::vector<const Module*> modules = {
      boards_.lidar != nullptr ? &boards_.lidar->detector() : &*lidar_detector_,
      boards_.camera != nullptr ? &boards_.camera->detector() : &*camera_detector_,
      &collector_};
  for (const Module* module : chain_.modules()) modules.push_back(module);
  return modules;
}

void OfflineRun::HandleAll() {
  while (bus_.HandleOnce(std::chrono::milliseconds(0))) {
  }
}

bool IsSamplesLog(const Rig& rig, const std::filesystem::path& log) {
  LogReader reader(log);
  bool has_events = false;
  try {
    while (const std::optional<LogEvent> event = reader.Next()) {
      if (event->channel == kSampleChannel) return true;
      if (event->channel == rig.channels.lidar_points ||
          event->channel == rig.channels.camera_image) {
        return false;
      }
      has_events = has_events || event->channel == kEventChannel;
    }
  } catch (const TruncatedLogError&) {  // told by whoever reads the log
  }
  return has_events;  // a session whose samples were all taken away
}

}  // namespace voqcal
