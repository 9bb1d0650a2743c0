#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace voqcal {

/// How many undelivered messages of a channel wait, at most.
enum class Queue {
  kState,  ///< Some tens, of state that travels whole: handlers keep the newest, Step works on it
           ///< once none waits. (LCM drops the newest when a queue is full: a capacity of 1 keeps
           ///< the oldest.)
  kEvery,  ///< A hundred: nothing is skipped unless the reader falls far behind (sensor data,
           ///< commands).
};

/// What a bus saw of one subscribed channel.
struct ChannelCounts {
  std::int64_t num_received = 0;
  /// Gaps in the sequence numbers (SequenceOf). Not counted with Queue::kState, whose next message
  /// repeats everything.
  std::int64_t num_lost = 0;
  std::int64_t num_malformed =
      0;                         ///< Could not be decoded; reported once a channel, counted always.
  std::int64_t num_foreign = 0;  ///< Of another session, and not taken.
};

/// The one way to LCM. Hides its traps: buffer sizes, EINTR, exceptions in handlers, queue depths,
/// malformed messages, failed publishes. For one thread.
class Bus {
 public:
  /// Warns if large messages cannot arrive by this URL (ReceiveBufferWarning).
  ///
  /// @param url  an LCM URL; "memq://" for one process alone; empty for kDefaultLcmUrl.
  /// @throws std::runtime_error for a URL with an LcmUrlProblem; if LCM cannot be created, with the
  ///     likely remedy.
  explicit Bus(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// From now on what is published names this session (HasSession), and what names another is not
  /// taken (MayBeOf): counted, and the first warned of. A bus without a session takes all.
  void SetSession(const std::string& session);

  /// Calls `handler` with each message of `channel`, from HandleOnce. Message is an lcm-gen type.
  /// A channel may have several handlers; its counts are kept by the first.
  ///
  /// @throws std::invalid_argument if LCM cannot carry `channel` (empty, or over 63 characters).
  /// @throws std::logic_error if the channel is already subscribed with another type.
  template <typename Message>
  void Subscribe(const std::string& channel,
                 Queue queue,
                 std::function<void(const Message&)> handler);
  /// The same, with the bytes of the message as they came; they are the handler's for the call.
  template <typename Message>
  void SubscribeWithBytes(
      const std::string& channel,
      Queue queue,
      std::function<void(const Message&, const std::uint8_t* bytes, std::size_t num_bytes)>
          handler);

  /// Keeps the newest message of a channel of state in `newest`, which must live as long as
  /// messages are handled.
  template <typename Message>
  void Keep(const std::string& channel, std::optional<Message>* newest) {
    Subscribe<Message>(
        channel, Queue::kState, [newest](const Message& message) { *newest = message; });
  }

  /// Counts a failure (and warns of the first) instead of throwing: the next second's message
  /// repeats all state.
  template <typename Message>
  void Publish(const std::string& channel, const Message& message);

  /// Bytes as they are, e.g. of a log event.
  void PublishBytes(const std::string& channel, const void* bytes, std::size_t num_bytes);

  /// Waits up to `timeout` for a message and handles it.
  /// @return true if one was handled; false on a time-out or a signal.
  /// @throws what a handler threw (the first, if several of one message did), and
  ///     std::runtime_error if LCM fails.
  bool HandleOnce(std::chrono::milliseconds timeout);
  /// Handles every message that waits, and those that come of them.
  /// @throws as HandleOnce.
  void HandleWaiting();

  const std::map<std::string, ChannelCounts>& channels() const;
  std::int64_t num_published() const;
  std::int64_t num_publish_failures() const;

 private:
  struct Impl;
  struct Subscription;

  /// What one delivery was, as the typed part of a subscription reports it.
  struct Delivery {
    std::string problem;                   ///< Why it could not be decoded; empty if it could.
    std::optional<std::int64_t> sequence;  ///< SequenceOf the message.
    std::string session;                   ///< SessionOf the message.
    std::function<void()> handle;          ///< Hands the decoded message to the subscriber.
  };
  using Decoder = std::function<Delivery(const void* bytes, std::size_t num_bytes)>;

  void SubscribeDecoder(const std::string& channel,
                        Queue queue,
                        std::int64_t fingerprint,
                        Decoder decoder);
  const std::string& session() const;
  void CountPublishFailure(const std::string& channel, const std::string& cause);

  std::unique_ptr<Impl> impl_;
};

/// Decodes all of `bytes`. lcm-gen's decoders answer a broken message with -1 or an exception, and
/// leave trailing bytes unread; here all of these are one text.
/// @return why it failed; empty if `message` holds the whole message.
template <typename Message>
std::string DecodeMessage(const void* bytes, std::size_t num_bytes, Message* message);

/// Why large messages will be lost with this URL, and the remedy; nothing if they will not.
///
/// LCM loses them without a trace: the kernel silently caps recv_buf_size at net.core.rmem_max, and
/// a datagram that finds the buffer full is gone.
///
/// @param granted_bytes  what the kernel gives a socket that asks for recv_buf_size; nothing if
/// unknown.
std::optional<std::string> ReceiveBufferWarning(const std::string& url,
                                                std::optional<std::int64_t> granted_bytes);

}  // namespace voqcal

#include "messaging/bus_impl.hpp"  // the templates
