#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "messaging/bus.hpp"
#include "messaging/encode.hpp"
#include "messaging/sequence.hpp"
#include "messaging/session_name.hpp"

namespace voqcal {

template <typename Message>
std::string DecodeMessage(const void* bytes, std::size_t num_bytes, Message* message) try {
  if (num_bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return std::to_string(num_bytes) + " bytes are more than LCM carries";
  }
  const int num_decoded = message->decode(bytes, 0, static_cast<int>(num_bytes));
  if (num_decoded < 0) {
    return std::to_string(num_bytes) + " bytes that are no " + Message::getTypeName();
  }
  if (static_cast<std::size_t>(num_decoded) != num_bytes) {
    return std::string(Message::getTypeName()) + " of " + std::to_string(num_decoded) +
           " bytes in a message of " + std::to_string(num_bytes);
  }
  return "";
} catch (const std::exception& error) {  // std::length_error, std::bad_alloc
  return std::string(Message::getTypeName()) + ": " + error.what();
}

template <typename Message>
void Bus::Subscribe(const std::string& channel,
                    Queue queue,
                    std::function<void(const Message&)> handler) {
  SubscribeWithBytes<Message>(
      channel,
      queue,
      [handler = std::move(handler)](const Message& message, const std::uint8_t*, std::size_t) {
        handler(message);
      });
}

template <typename Message>
void Bus::SubscribeWithBytes(
    const std::string& channel,
    Queue queue,
    std::function<void(const Message&, const std::uint8_t*, std::size_t)> handler) {
  SubscribeDecoder(channel,
                   queue,
                   Message::getHash(),
                   [handler = std::move(handler)](const void* bytes, std::size_t num_bytes) {
                     const auto message = std::make_shared<Message>();
                     Delivery delivery;
                     delivery.problem = DecodeMessage(bytes, num_bytes, message.get());
                     if (!delivery.problem.empty()) return delivery;
                     delivery.sequence = SequenceOf(*message);
                     delivery.session = SessionOf(*message);
                     delivery.handle = [message, &handler, bytes, num_bytes] {
                       handler(*message, static_cast<const std::uint8_t*>(bytes), num_bytes);
                     };
                     return delivery;
                   });
}

template <typename Message>
void Bus::Publish(const std::string& channel, const Message& message) {
  std::vector<std::uint8_t> bytes;
  if constexpr (HasSession<Message>::value) {
    if (!session().empty() && message.session != session()) {
      Message named = message;
      named.session = session();
      bytes = EncodeMessage(named);
    }
  }
  if (bytes.empty()) bytes = EncodeMessage(message);
  if (bytes.empty()) {
    CountPublishFailure(channel, std::string("cannot encode ") + Message::getTypeName());
    return;
  }
  PublishBytes(channel, bytes.data(), bytes.size());
}

}  // namespace voqcal
