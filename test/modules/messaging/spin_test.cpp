#include "messaging/spin.hpp"

#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/status.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

/// A module whose Step is the test's.
class ScriptedModule : public Module {
 public:
  std::string Name() const override { return "scripted"; }
  bool Step() override {
    ++num_steps;
    Count("steps");
    return step ? step() : false;
  }
  bool IsDone() const override { return is_done; }
  void Republish() override { ++num_republished; }
  void CountOne(const std::string& what) { Count(what); }

  std::function<bool()> step;
  bool is_done = false;
  int num_steps = 0;
  int num_republished = 0;
};

/// A bus that keeps every MODULE_STATUS sent on it.
struct Recorder {
  Bus bus{"memq://"};
  std::vector<module_status_t> statuses;

  Recorder() {
    bus.Subscribe<module_status_t>("STATUS", Queue::kEvery, [this](const module_status_t& message) {
      statuses.push_back(message);
    });
  }
  std::vector<module_status_t> Drain() {
    while (bus.HandleOnce(milliseconds(0))) {
    }
    return statuses;
  }
};

class SpinSignal : public testing::TestWithParam<int> {};

TEST_P(SpinSignal, EndsIt) {
  Recorder recorder;
  ScriptedModule module;
  module.step = [&] {
    if (module.num_steps == 2) std::raise(GetParam());
    return true;
  };
  Spin(recorder.bus, module, "STATUS");
  EXPECT_EQ(module.num_steps, 2);
  const auto statuses = recorder.Drain();
  ASSERT_GE(statuses.size(), 2U);
  EXPECT_EQ(statuses.front().state, "running");
  EXPECT_EQ(statuses.back().state, "stopped");
  EXPECT_GE(module.num_republished, 1);
}

INSTANTIATE_TEST_SUITE_P(IntAndTerm, SpinSignal, testing::Values(SIGINT, SIGTERM));

TEST(Spin, EndsWhenTheModuleIsDone) {
  Recorder recorder;
  ScriptedModule module;
  module.step = [&] {
    module.is_done = module.num_steps == 3;
    return true;
  };
  Spin(recorder.bus, module, "STATUS");
  EXPECT_EQ(module.num_steps, 3);
  EXPECT_EQ(recorder.Drain().back().state, "done");
}

TEST(Spin, HandlesWaitingMessagesBeforeItSteps) {
  Bus bus("memq://");
  ScriptedModule module;
  std::vector<int> num_steps_at_message;
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, [&](const event_t&) {
    num_steps_at_message.push_back(module.num_steps);
  });
  for (int i = 0; i < 3; ++i) bus.Publish("EVENT", event_t{});
  module.step = [&] { return !(module.is_done = true); };
  Spin(bus, module, "STATUS");
  EXPECT_THAT(num_steps_at_message, ElementsAre(0, 0, 0));
  EXPECT_EQ(module.num_steps, 1);
}

TEST(Spin, StatesAFailureThenThrowsIt) {
  Recorder recorder;
  ScriptedModule module;
  module.step = []() -> bool { throw std::runtime_error("disk is full"); };
  EXPECT_THROW(Spin(recorder.bus, module, "STATUS"), std::runtime_error);
  EXPECT_EQ(recorder.Drain().back().state, "failed: disk is full");
}

TEST(Spin, StatesTheFailureOfAHandler) {
  Recorder recorder;
  ScriptedModule module;
  recorder.bus.Subscribe<event_t>(
      "EVENT", Queue::kEvery, [](const event_t&) { throw std::runtime_error("bad event"); });
  recorder.bus.Publish("EVENT", event_t{});
  EXPECT_THROW(Spin(recorder.bus, module, "STATUS"), std::runtime_error);
  EXPECT_EQ(recorder.Drain().back().state, "failed: bad event");
}

TEST(StopOnSignal, PutsTheOldHandlersBack) {
  struct sigaction before {};
  sigaction(SIGTERM, nullptr, &before);
  { const StopOnSignal stop; }
  struct sigaction after {};
  sigaction(SIGTERM, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(StatusPublisher, StatesChannelsRatesAndCounters) {
  Bus bus("memq://");
  ScriptedModule module;
  StatusPublisher status(bus, "STATUS");
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, [](const event_t&) {});
  const auto start = StatusPublisher::Clock::now();
  status.Publish(module, "waiting for events", start);
  for (const std::int64_t seq : {1, 2, 5}) {
    event_t event{};
    event.seq = seq;
    bus.Publish("EVENT", event);
  }
  while (bus.HandleOnce(milliseconds(0))) {
  }
  module.CountOne("boards");
  module.CountOne("boards");

  std::vector<module_status_t> statuses;
  bus.Subscribe<module_status_t>("STATUS", Queue::kEvery, [&](const module_status_t& message) {
    statuses.push_back(message);
  });
  status.Publish(module, "running", start + milliseconds(500));
  while (bus.HandleOnce(milliseconds(0))) {
  }
  ASSERT_EQ(statuses.size(), 1U);
  const module_status_t& message = statuses.front();
  EXPECT_EQ(message.seq, 2);
  EXPECT_EQ(message.module, "scripted");
  EXPECT_EQ(message.state, "running");
  EXPECT_EQ(message.num_published, 1 + 3);
  ASSERT_EQ(message.num_channels, 2);
  EXPECT_EQ(message.channels[0].channel, "EVENT");
  EXPECT_EQ(message.channels[0].num_received, 3);
  EXPECT_EQ(message.channels[0].num_lost, 2);
  EXPECT_DOUBLE_EQ(message.channels[0].rate_hz, 3 / 0.5);
  ASSERT_EQ(message.num_counters, 1);
  EXPECT_EQ(message.counters[0].name, "boards");
  EXPECT_EQ(message.counters[0].count, 2);
}

TEST(ModuleSummary, ListsTheCounters) {
  ScriptedModule module;
  EXPECT_EQ(module.Summary(), "nothing to count");
  module.CountOne("sweeps");
  module.CountOne("no plane");
  module.CountOne("sweeps");
  EXPECT_EQ(module.Summary(), "1 no plane, 2 sweeps");
}

}  // namespace
}  // namespace voqcal
