#include "calibrate/detected_boards.hpp"

#include <chrono>
#include <exception>
#include <optional>
#include <stdexcept>

#include "calibrate/recording_clocks.hpp"
#include "camera_board_detector/camera_board_detector_node.hpp"
#include "lidar_board_detector/lidar_board_detector_node.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/lidar_board_t.hpp"

namespace voqcal {
namespace {

std::optional<LogEvent> NextOrEnd(LogReader* reader) {
  try {
    return reader->Next();
  } catch (const TruncatedLogError&) {  // told by who collects the samples
    return std::nullopt;
  }
}

}  // namespace

DetectedBoards::DetectedBoards(const Rig& rig,
                               Sensor sensor,
                               const std::filesystem::path& log,
                               bool use_log_times,
                               const std::function<void(double share)>& on_progress)
    : bus_("memq://") {
  const bool is_lidar = sensor == Sensor::kLidar;
  if (is_lidar) {
    Listen<LidarBoardDetectorNode, lidar_board_t>(rig, rig.channels.lidar_board);
  } else {
    Listen<CameraBoardDetectorNode, camera_board_t>(rig, rig.channels.camera_board);
  }
  const std::string& input = is_lidar ? rig.channels.lidar_points : rig.channels.camera_image;
  LogReader reader(log);
  while (std::optional<LogEvent> event = NextOrEnd(&reader)) {
    if (event->channel != input) continue;
    if (use_log_times) TakeLogTime(&*event);
    end_of_event_ = reader.offset();
    try {
      bus_.PublishBytes(input, event->bytes.data(), event->bytes.size());
      while (bus_.HandleOnce(std::chrono::milliseconds(0))) {
      }
    } catch (const std::exception& error) {
      throw std::runtime_error(log.string() + ": event " + std::to_string(event->number) + " (" +
                               input + "): " + error.what());
    }
    on_progress(static_cast<double>(reader.offset()) / static_cast<double>(reader.num_bytes()));
  }
}

template <typename Detector, typename BoardMessage>
void DetectedBoards::Listen(const Rig& rig, const std::string& board_channel) {
  detector_ = std::make_unique<Detector>(rig, &bus_);
  bus_.Subscribe<BoardMessage>(board_channel, Queue::kEvery, [this](const BoardMessage& message) {
    boards_[end_of_event_].push_back(EncodeMessage(message));
  });
}

const std::vector<std::vector<std::uint8_t>>& DetectedBoards::Of(std::int64_t end_of_event) const {
  static const std::vector<std::vector<std::uint8_t>> kNone;
  const auto found = boards_.find(end_of_event);
  return found == boards_.end() ? kNone : found->second;
}

}  // namespace voqcal
