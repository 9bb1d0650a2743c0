#include "messaging/session_misses.hpp"

#include <optional>
#include <stdexcept>

#include "messaging/bus.hpp"
#include "messaging/log.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {
namespace {

template <typename Message>
bool Decode(const LogEvent& event, Message* message) {
  return DecodeMessage(event.bytes.data(), event.bytes.size(), message).empty();
}

void Take(const LogEvent& frame, const LogEvent& said, SessionMisses* misses) {
  if (said.channel == kLidarMissChannel) {
    SweepMiss miss;
    if (Decode(frame, &miss.sweep) && Decode(said, &miss.board)) misses->sweeps.push_back(miss);
  } else if (said.channel == kCameraMissChannel) {
    ImageMiss miss;
    if (Decode(frame, &miss.image) && Decode(said, &miss.board)) misses->images.push_back(miss);
  }
}

}  // namespace

SessionMisses ReadMisses(const std::filesystem::path& session_folder) {
  SessionMisses misses;
  const std::filesystem::path path = session_folder / kMissesLogName;
  if (!std::filesystem::exists(path)) return misses;
  try {
    LogReader reader(path);
    LogEvent before;
    while (const std::optional<LogEvent> event = reader.Next()) {
      module_status_t counts{};
      if (event->channel == kMissCountsChannel && Decode(*event, &counts)) {
        misses.counts = counts.counters;
        const std::string mark = "trouble: ";
        if (counts.state.rfind(mark, 0) == 0) misses.trouble = counts.state.substr(mark.size());
      }
      Take(before, *event, &misses);
      before = *event;
    }
  } catch (const std::runtime_error&) {  // it tells of a failure, and is no place for another
  }
  return misses;
}

}  // namespace voqcal
