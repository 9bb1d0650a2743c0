#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace voqcal {

/// Many enough for a burst of small messages; recv_buf_size is what lets images and sweeps arrive.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// How many undelivered messages of a channel wait, at most.
enum class Queue {
  kLatest,  ///< One: a slow reader skips to the newest (state that travels whole).
  kEvery,   ///< Hundreds: nothing is skipped unless the reader falls far behind (sensor data, commands).
};

/// What a bus saw of one subscribed channel.
struct ChannelCounts {
  std::int64_t num_received = 0;
  std::int64_t num_lost = 0;       ///< Gaps in the sequence numbers (messages that carry one).
  std::int64_t num_malformed = 0;  ///< Could not be decoded; reported once a channel, counted always.
};

/// The one way to LCM. Hides its traps: buffer sizes, EINTR, exceptions in handlers, queue depths,
/// malformed messages, failed publishes.
class Bus {
 public:
  /// @param url  an LCM URL; "memq://" for one process alone.
  /// @throws std::runtime_error if LCM cannot be created, with the likely remedy.
  explicit Bus(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Calls `handler` with each message of `channel`, from HandleOnce. Message is an lcm-gen type.
  template <typename Message>
  void Subscribe(const std::string& channel,
                 Queue queue,
                 std::function<void(const Message&)> handler);

  /// Counts a failure instead of throwing: the next second's message repeats all state.
  template <typename Message>
  void Publish(const std::string& channel, const Message& message);

  /// Bytes as they are, e.g. of a log event.
  void PublishBytes(const std::string& channel, const void* bytes, std::size_t num_bytes);

  /// Waits up to `timeout` for a message and handles it.
  /// @return true if one was handled; false on a time-out or a signal.
  /// @throws what a handler threw, and std::runtime_error if LCM fails.
  bool HandleOnce(std::chrono::milliseconds timeout);

  const std::map<std::string, ChannelCounts>& channels() const;
  std::int64_t num_published() const;
  std::int64_t num_publish_failures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voqcal
