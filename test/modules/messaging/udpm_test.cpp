// The bus on a real network: run in a network namespace of its own (see CMakeLists.txt).
#include <chrono>
#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "messaging/bus.hpp"
#include "messaging/spin.hpp"
#include "rig/lcm_url.hpp"
#include "voqcal/event_t.hpp"

namespace voqcal {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class IdleModule : public Module {
 public:
  std::string Name() const override { return "idle"; }
};

TEST(UdpmWithoutRoute, NamesTheRemedy) {
  try {
    const Bus bus(kDefaultLcmUrl);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("ip route add 224.0.0.0/4 dev lo"));
  }
}

TEST(Udpm, CarriesMessagesBetweenInstances) {
  Bus sender(kDefaultLcmUrl);
  Bus reader(kDefaultLcmUrl);
  int num_received = 0;
  reader.Subscribe<event_t>("EVENT", Queue::kEvery, [&](const event_t&) { ++num_received; });
  for (int i = 1; i <= 20; ++i) {
    event_t event{};
    event.seq = i;
    sender.Publish("EVENT", event);
  }
  while (num_received < 20 && reader.HandleOnce(milliseconds(2000))) {
  }
  EXPECT_EQ(num_received, 20);
  EXPECT_EQ(reader.channels().at("EVENT").num_lost, 0);
}

/// Sends the numbers 1 to 20 and lets them all arrive before the first is handled.
std::vector<std::int64_t> ReceivedOfTwenty(Queue queue) {
  Bus sender(kDefaultLcmUrl);
  Bus reader(kDefaultLcmUrl);
  std::vector<std::int64_t> received;
  reader.Subscribe<event_t>(
      "EVENT", queue, [&](const event_t& event) { received.push_back(event.seq); });
  for (int i = 1; i <= 20; ++i) {
    event_t event{};
    event.seq = i;
    sender.Publish("EVENT", event);
  }
  std::this_thread::sleep_for(milliseconds(300));
  while (reader.HandleOnce(milliseconds(0))) {
  }
  return received;
}

TEST(Udpm, QueuesAsAsked) {
  EXPECT_EQ(ReceivedOfTwenty(Queue::kEvery).size(), 20U);
  const std::vector<std::int64_t> states = ReceivedOfTwenty(Queue::kState);
  ASSERT_FALSE(states.empty());
  EXPECT_EQ(states.back(), 20);  // whatever is skipped, it is not the newest
}

TEST(Udpm, SignalEndsAnIdleModule) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Bus bus(kDefaultLcmUrl);
    IdleModule module;
    bus.Subscribe<event_t>("EVENT", Queue::kEvery, [](const event_t&) {});
    std::thread sender([signal] {
      std::this_thread::sleep_for(milliseconds(300));
      kill(getpid(), signal);  // to the process: any thread may get it
    });
    Spin(bus, module, "STATUS");  // ctest's time-out ends the test if this does not return
    sender.join();
  }
}

}  // namespace
}  // namespace voqcal
