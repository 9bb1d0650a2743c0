#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "rig/rig.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// Every message of one channel, from the inbox's making on.
template <typename Message>
class Inbox {
 public:
  Inbox(Bus* bus, const std::string& channel) {
    bus->Subscribe<Message>(
        channel, Queue::kEvery, [this](const Message& message) { messages.push_back(message); });
  }
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  std::vector<Message> messages;
};

/// Handles all that waits, and what that gives rise to.
inline void HandleAll(Bus* bus) {
  while (bus->HandleOnce(std::chrono::milliseconds(0))) {
  }
}

template <typename Message>
void Send(Bus* bus, const std::string& channel, const Message& message) {
  bus->Publish(channel, message);
  HandleAll(bus);
}

using Counters = std::map<std::string, std::int64_t>;

/// The rig of the synthetic samples: their board and camera, all else by default.
inline Rig TestRig() {
  Rig rig;
  rig.name = "test";
  rig.sha256 = "rig's hash";
  rig.board = TestBoard();
  rig.camera = TestCamera();
  return rig;
}

}  // namespace voqcal::test
