#include "sample_collector/session_log.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <system_error>

#include "messaging/bus.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/encode.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/sample_t.hpp"

namespace voqcal {
namespace {

template <typename Message>
Message Decode(const LogEvent& event) {
  Message message{};
  const std::string problem = DecodeMessage(event.bytes.data(), event.bytes.size(), &message);
  if (!problem.empty()) {
    throw std::runtime_error("event " + std::to_string(event.number) + " (" + event.channel +
                             "): " + problem);
  }
  return message;
}

std::filesystem::path MakeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(folder.string() +
                             ": cannot make the session's folder: " + error.message());
  }
  return folder / kSamplesLogName;
}

}  // namespace

SessionLog::SessionLog(const std::filesystem::path& folder)
    : path_(MakeFolder(folder)), writer_(path_) {
  try {
    ReadAgain();
  } catch (const std::exception& error) {
    throw std::runtime_error(path_.string() + ": is no log of samples: " + error.what());
  }
}

std::int64_t SessionLog::Accept(BoardSample sample, const SampleScene& scene) {
  sample.id = std::max(sample.id, next_id_);
  Change change;
  if (scene.IsWhole()) {
    change.push_back(Event(kSceneSweepChannel, scene.sweep->utime, scene.sweep->bytes));
    change.push_back(Event(kSceneImageChannel, scene.image->utime, scene.image->bytes));
  }
  change.push_back(Event(kSampleChannel, sample.utime, EncodeMessage(ToMessage(sample))));
  Append(change);
  return sample.id;
}

std::optional<std::int64_t> SessionLog::Discard(std::int64_t id) {
  if (id == 0 && !samples_.empty()) id = samples_.back().id;
  const auto sample = std::find_if(
      samples_.begin(), samples_.end(), [id](const BoardSample& each) { return each.id == id; });
  if (sample == samples_.end()) return {};
  event_t event{};
  event.utime = sample->utime;
  event.seq = revision_;
  event.kind = "discarded";
  event.sample_id = id;
  Append({Event(kEventChannel, event.utime, EncodeMessage(event))});
  return id;
}

void SessionLog::Reset() {
  event_t event{};
  event.utime = samples_.empty() ? 0 : samples_.back().utime;
  event.seq = revision_;
  event.kind = "reset";
  Append({Event(kEventChannel, event.utime, EncodeMessage(event))});
}

LogEvent SessionLog::Event(const char* channel,
                           std::int64_t utime,
                           std::vector<std::uint8_t> bytes) const {
  return {revision_, utime, channel, std::move(bytes)};
}

// The writer has cut off an event that a crash left half-written; a scene whose sample the crash
// took is cut off here.
void SessionLog::ReadAgain() {
  LogReader reader(path_);
  std::int64_t end = 0;  // of the last change
  Change change;
  while (std::optional<LogEvent> event = reader.Next()) {
    const bool is_scene =
        event->channel == kSceneSweepChannel || event->channel == kSceneImageChannel;
    change.push_back(*std::move(event));
    if (is_scene) continue;
    Apply(change);
    change.clear();
    end = reader.offset();
  }
  if (!change.empty()) writer_.CutAt(end);
}

void SessionLog::Append(const Change& change) {
  for (const LogEvent& event : change) writer_.Write(event);
  writer_.Flush();
  Apply(change);
}

// One way to change the samples, whether the change is new or read again: both give the same state.
void SessionLog::Apply(const Change& change) {
  for (const LogEvent& each : change) {
    const std::vector<std::uint8_t> bytes = EncodeLogEvent(each);
    file_hash_.Add(bytes.data(), bytes.size());
  }
  const LogEvent& event = change.back();
  if (event.channel == kSampleChannel) {
    samples_.push_back(FromMessage(Decode<sample_t>(event)));
    next_id_ = samples_.back().id + 1;
  } else if (event.channel == kEventChannel) {
    const event_t fate = Decode<event_t>(event);
    if (fate.kind == "reset") {
      samples_.clear();
    } else {
      samples_.erase(
          std::remove_if(samples_.begin(),
                         samples_.end(),
                         [&fate](const BoardSample& each) { return each.id == fate.sample_id; }),
          samples_.end());
    }
  } else {
    throw std::runtime_error("it has channel " + event.channel);
  }
  ++revision_;
}

}  // namespace voqcal
