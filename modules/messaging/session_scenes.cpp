#include "messaging/session_scenes.hpp"

#include <stdexcept>
#include <string>

#include "messaging/bus.hpp"
#include "voqcal/sample_t.hpp"

namespace voqcal {
namespace {

template <typename Message>
Message Decode(const LogEvent& event, const std::filesystem::path& path) {
  Message message{};
  const std::string problem = DecodeMessage(event.bytes.data(), event.bytes.size(), &message);
  if (!problem.empty()) {
    throw std::runtime_error(path.string() + ": event " + std::to_string(event.number) + " (" +
                             event.channel + "): " + problem);
  }
  return message;
}

}  // namespace

SessionSceneReader::SessionSceneReader(const std::filesystem::path& samples_log)
    : path_(samples_log), reader_(samples_log) {}

std::optional<LogEvent> SessionSceneReader::NextEvent() {
  try {
    return reader_.Next();
  } catch (const TruncatedLogError&) {
    return std::nullopt;
  }
}

std::optional<SessionScene> SessionSceneReader::Next() {
  std::optional<LogEvent> sweep;
  std::optional<LogEvent> image;
  while (std::optional<LogEvent> event = NextEvent()) {
    if (event->channel == kSceneSweepChannel) {
      sweep = std::move(event);
    } else if (event->channel == kSceneImageChannel) {
      image = std::move(event);
    } else if (event->channel == kSampleChannel && sweep && image) {
      return SessionScene{Decode<sample_t>(*event, path_).id,
                          Decode<pointcloud2_t>(*sweep, path_),
                          Decode<image_t>(*image, path_)};
    } else {
      sweep.reset();
      image.reset();
    }
  }
  return std::nullopt;
}

}  // namespace voqcal
