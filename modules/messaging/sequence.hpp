#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "voqcal/image_t.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// The metadata key under which an image_t carries its sequence number: the type has no field for
/// it.
inline constexpr char kImageSeqKey[] = "seq";

template <typename Message, typename = void>
struct HasSeq : std::false_type {};
template <typename Message>
struct HasSeq<Message, std::void_t<decltype(std::declval<const Message&>().seq)>> : std::true_type {
};

/// The number by which a lost message shows, or nothing if the type has none. It counts up by one
/// with each message of a channel. Bus finds overloads for other types beside the type (ADL).
template <typename Message>
std::optional<std::int64_t> SequenceOf(const Message& message) {
  if constexpr (HasSeq<Message>::value) {
    return static_cast<std::int64_t>(message.seq);
  } else {
    return std::nullopt;
  }
}

/// How many messages were lost before the one numbered `sequence`, after the one numbered `last`. A
/// number that is not above the last one is a sender that started anew (or a recording played
/// again), or one that does not number its messages; neither is a loss.
inline std::int64_t NumLostBetween(std::int64_t last, std::int64_t sequence) {
  if (sequence <= last) return 0;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  const auto gap = static_cast<std::uint64_t>(sequence) - static_cast<std::uint64_t>(last) - 1;
  return static_cast<std::int64_t>(std::min(gap, kMost));
}

/// Every module counts its own heartbeats on one shared channel, so gaps there mean nothing.
inline std::optional<std::int64_t> SequenceOf(const module_status_t&) { return std::nullopt; }

inline std::optional<std::int64_t> SequenceOf(const image_t& message) {
  for (const image_metadata_t& entry : message.metadata) {
    if (entry.key != kImageSeqKey) continue;
    const std::string text(entry.value.begin(), entry.value.end());
    std::int64_t seq = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), seq);
    if (parsed.ec == std::errc() && parsed.ptr == text.data() + text.size()) return seq;
  }
  return std::nullopt;
}

}  // namespace voqcal
