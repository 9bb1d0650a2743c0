#include "check_recording/recording_contents.hpp"

#include <algorithm>

#include "core/format.hpp"
#include "messaging/bus.hpp"
#include "messaging/sequence.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;
/// A message begins with its type's fingerprint, the highest byte first.
constexpr std::size_t kFingerprintBytes = 8;

std::int64_t FingerprintOf(const LogEvent& event) {
  std::uint64_t fingerprint = 0;
  if (event.bytes.size() < kFingerprintBytes) return 0;
  for (std::size_t i = 0; i < kFingerprintBytes; ++i) {
    fingerprint = (fingerprint << 8) | event.bytes[i];
  }
  return static_cast<std::int64_t>(fingerprint);
}

void TakeSequence(std::int64_t sequence, std::int64_t utime, ChannelContents* channel) {
  const std::optional<std::int64_t> last = channel->last_sequence;
  channel->last_sequence = sequence;
  if (!last) return;
  channel->is_numbered = channel->is_numbered || sequence != *last;
  const std::int64_t num_lost = NumLostBetween(*last, sequence);
  channel->num_lost += num_lost;
  if (num_lost > 0 && !channel->first_loss_utime) channel->first_loss_utime = utime;
}

/// Counts an event that is a Message.
template <typename Message>
void TakeAs(const LogEvent& event, ChannelContents::Kind kind, ChannelContents* channel) {
  if (FingerprintOf(event) != Message::getHash()) return;
  channel->kind = kind;
  Message message{};
  if (!DecodeMessage(event.bytes.data(), event.bytes.size(), &message).empty()) {
    ++channel->num_unreadable;
  } else if (const std::optional<std::int64_t> sequence = SequenceOf(message)) {
    TakeSequence(*sequence, event.utime, channel);
  }
}

void Append(const std::string& what, std::string* text) {
  *text += (text->empty() ? "" : "; ") + what;
}

}  // namespace

std::optional<double> ChannelContents::RateHz() const {
  if (num_messages < 2 || last_utime <= first_utime) return std::nullopt;
  return static_cast<double>(num_messages - 1) * kMicrosecondsPerSecond /
         static_cast<double>(last_utime - first_utime);
}

void RecordingContents::Take(const LogEvent& event) {
  if (channels.empty()) begin_utime = end_utime = event.utime;
  end_utime = std::max(end_utime, event.utime);
  ChannelContents& channel = channels[event.channel];
  if (channel.num_messages++ == 0) channel.first_utime = event.utime;
  channel.last_utime = event.utime;
  TakeAs<image_t>(event, ChannelContents::Kind::kImages, &channel);
  TakeAs<pointcloud2_t>(event, ChannelContents::Kind::kSweeps, &channel);
}

std::int64_t RecordingContents::NumLost() const {
  std::int64_t num_lost = 0;
  for (const auto& [name, channel] : channels) num_lost += channel.num_lost;
  return num_lost;
}

std::string RecordingContents::Missing() const {
  std::string text;
  for (const auto& [name, channel] : channels) {
    if (channel.num_lost > 0) {
      const auto after_us = static_cast<double>(*channel.first_loss_utime - begin_utime);
      Append(Format("%s: %lld of %lld lost, the first %.1f s after the start",
                    name.c_str(),
                    static_cast<long long>(channel.num_lost),
                    static_cast<long long>(channel.num_lost + channel.num_messages),
                    after_us / kMicrosecondsPerSecond),
             &text);
    }
    if (channel.num_unreadable > 0) {
      Append(name + ": " + std::to_string(channel.num_unreadable) + " unreadable", &text);
    }
  }
  if (num_damaged > 0) Append("damaged places: " + std::to_string(num_damaged), &text);
  if (num_cut_bytes > 0) {
    Append("cut off within a message, whose " + std::to_string(num_cut_bytes) + " bytes are lost",
           &text);
  }
  return text;
}

std::string RecordingContents::Unknown() const {
  std::string text;
  bool has_images = false;
  bool has_sweeps = false;
  for (const auto& [name, channel] : channels) {
    has_images = has_images || channel.kind == ChannelContents::Kind::kImages;
    has_sweeps = has_sweeps || channel.kind == ChannelContents::Kind::kSweeps;
    const bool is_of_sensor = channel.kind != ChannelContents::Kind::kOther;
    if (is_of_sensor && !channel.is_numbered) Append(name + " is not numbered", &text);
  }
  if (!has_images) Append("no images", &text);
  if (!has_sweeps) Append("no sweeps", &text);
  return text;
}

RecordingContents ContentsOf(const std::vector<std::filesystem::path>& logs,
                             const std::function<void(double share)>& on_progress) {
  std::int64_t num_all_bytes = 0;
  for (const std::filesystem::path& log : logs) num_all_bytes += LogReader(log).num_bytes();
  RecordingContents contents;
  for (const std::filesystem::path& log : logs) {
    LogReader reader(log);
    const std::int64_t num_bytes_before = contents.num_bytes;
    contents.num_bytes += reader.num_bytes();
    try {
      while (const std::optional<LogEvent> event = reader.Next()) {
        contents.Take(*event);
        if (!on_progress) continue;
        on_progress(static_cast<double>(num_bytes_before + reader.offset()) /
                    static_cast<double>(num_all_bytes));
      }
    } catch (const TruncatedLogError& error) {
      contents.num_cut_bytes += reader.num_bytes() - error.offset();
    }
    contents.num_damaged += reader.num_damaged();
  }
  return contents;
}

}  // namespace voqcal
