#include "sample_collector/miss_examples.hpp"

#include <utility>

#include <system_error>

#include "core/format.hpp"
#include "messaging/encode.hpp"
#include "messaging/session_misses.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxExamples = 2;
constexpr std::size_t kMaxBytes = 96U << 20U;

bool IsPowerOfTwo(std::int64_t number) { return (number & (number - 1)) == 0; }

std::size_t NumBytes(const std::vector<LogEvent>& events) {
  std::size_t num_bytes = 0;
  for (const LogEvent& event : events) num_bytes += event.bytes.size();
  return num_bytes;
}

}  // namespace

// Those whose number is a power of two: the last of them are of the middle of the session and of
// its end, whenever that is.
void MissExamples::Note(const std::string& frame_channel,
                        const std::string& board_channel,
                        const std::string& reason,
                        const SensorFrame* frame,
                        const std::vector<std::uint8_t>& board) {
  Kept& kept = of_reason_[board_channel + ": " + WithoutNumbers(reason)];
  ++kept.num_times;
  if (frame == nullptr || !IsPowerOfTwo(kept.num_times)) return;
  Example example = {{0, frame->utime, frame_channel, frame->bytes},
                     {0, frame->utime, board_channel, board}};
  if (kept.examples.size() == kMaxExamples) {
    num_bytes_ -= NumBytes(kept.examples.front());
    kept.examples.pop_front();
  }
  if (num_bytes_ + NumBytes(example) > kMaxBytes) return;
  num_bytes_ += NumBytes(example);
  kept.examples.push_back(std::move(example));
}

void MissExamples::Clear() {
  of_reason_.clear();
  num_bytes_ = 0;
}

void MissExamples::Save(const std::filesystem::path& session_folder,
                        const Module& collector) const {
  module_status_t counts{};
  counts.module = collector.Name();
  counts.state = collector.State();
  const auto count = [&counts](const std::string& name, std::int64_t num_times) {
    counts.counters.push_back({name, num_times});
  };
  for (const auto& [reason, kept] : of_reason_) count(reason, kept.num_times);
  for (const auto& [reason, num_times] : collector.counters()) count(reason, num_times);
  counts.num_counters = static_cast<std::int32_t>(counts.counters.size());

  const std::filesystem::path path = session_folder / kMissesLogName;
  std::error_code error;
  std::filesystem::remove(path, error);  // what cannot be removed cannot be written either
  LogWriter writer(path);
  writer.Write({0, 0, kMissCountsChannel, EncodeMessage(counts)});
  for (const auto& [reason, kept] : of_reason_) {
    for (const Example& example : kept.examples) {
      for (const LogEvent& event : example) writer.Write(event);
    }
  }
}

}  // namespace voqcal
