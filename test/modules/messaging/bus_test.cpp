#include "messaging/bus.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/convert_image.hpp"
#include "messaging/sequence.hpp"
#include "rig/lcm_url.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/pointcloud2_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr milliseconds kNoWait{0};

event_t Event(std::int64_t seq) {
  event_t message{};
  message.seq = seq;
  return message;
}

void HandleAll(Bus* bus) {
  while (bus->HandleOnce(kNoWait)) {
  }
}

/// Loss count of one channel on which events with these numbers arrive.
std::int64_t LossesOf(const std::vector<std::int64_t>& sequences, Queue queue = Queue::kEvery) {
  Bus bus("memq://");
  bus.Subscribe<event_t>("EVENT", queue, [](const event_t&) {});
  for (const std::int64_t seq : sequences) bus.Publish("EVENT", Event(seq));
  HandleAll(&bus);
  return bus.channels().at("EVENT").num_lost;
}

TEST(Bus, CarriesMessagesInOrder) {
  Bus bus("memq://");
  std::vector<std::int64_t> received;
  bus.Subscribe<event_t>(
      "EVENT", Queue::kEvery, [&](const event_t& event) { received.push_back(event.seq); });
  for (std::int64_t seq = 1; seq <= 3; ++seq) bus.Publish("EVENT", Event(seq));
  HandleAll(&bus);
  EXPECT_THAT(received, ElementsAre(1, 2, 3));
  EXPECT_EQ(bus.channels().at("EVENT").num_received, 3);
  EXPECT_EQ(bus.num_published(), 3);
  EXPECT_EQ(bus.num_publish_failures(), 0);
}

TEST(Bus, HandsOverTheBytesAsTheyCame) {
  Bus bus("memq://");
  std::vector<std::uint8_t> received;
  bus.SubscribeWithBytes<event_t>(
      "EVENT",
      Queue::kEvery,
      [&](const event_t& event, const std::uint8_t* bytes, std::size_t num_bytes) {
        EXPECT_EQ(event.seq, 7);
        received.assign(bytes, bytes + num_bytes);
      });
  bus.Publish("EVENT", Event(7));
  HandleAll(&bus);
  EXPECT_EQ(received, EncodeMessage(Event(7)));
}

TEST(Bus, TimesOutWithoutMessages) {
  Bus bus("memq://");
  EXPECT_FALSE(bus.HandleOnce(kNoWait));
  EXPECT_FALSE(bus.HandleOnce(milliseconds(-5)));
}

TEST(Bus, KeepsInstancesApart) {
  Bus sender("memq://");
  Bus reader("memq://");
  reader.Subscribe<event_t>("EVENT", Queue::kEvery, [](const event_t&) { FAIL(); });
  sender.Publish("EVENT", Event(1));
  EXPECT_FALSE(reader.HandleOnce(kNoWait));
}

TEST(Bus, ServesSeveralHandlersOfAChannelAndCountsOnce) {
  Bus bus("memq://");
  int num_first = 0;
  int num_second = 0;
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, [&](const event_t&) { ++num_first; });
  bus.Subscribe<event_t>("EVENT", Queue::kState, [&](const event_t&) { ++num_second; });
  bus.Publish("EVENT", Event(1));
  HandleAll(&bus);
  EXPECT_EQ(num_first, 1);
  EXPECT_EQ(num_second, 1);
  EXPECT_EQ(bus.channels().at("EVENT").num_received, 1);
}

TEST(Bus, LetsAHandlerPublish) {
  Bus bus("memq://");
  int num_replies = 0;
  bus.Subscribe<event_t>(
      "ASK", Queue::kEvery, [&](const event_t&) { bus.Publish("REPLY", Event(1)); });
  bus.Subscribe<event_t>("REPLY", Queue::kEvery, [&](const event_t&) { ++num_replies; });
  bus.Publish("ASK", Event(1));
  HandleAll(&bus);
  EXPECT_EQ(num_replies, 1);
}

TEST(Bus, TakesChannelNamesLiterally) {
  Bus bus("memq://");
  int num_received = 0;
  bus.Subscribe<event_t>("RIG.1+", Queue::kEvery, [&](const event_t&) { ++num_received; });
  bus.Publish("RIGX11", Event(1));
  bus.Publish("RIG.1+", Event(1));
  HandleAll(&bus);
  EXPECT_EQ(num_received, 1);
}

TEST(Bus, ThrowsWhatAHandlerThrewAndGoesOn) {
  Bus bus("memq://");
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, [](const event_t& event) {
    if (event.seq == 1) throw std::domain_error("no such sample");
  });
  bus.Publish("EVENT", Event(1));
  bus.Publish("EVENT", Event(2));
  EXPECT_THROW(bus.HandleOnce(kNoWait), std::domain_error);
  EXPECT_TRUE(bus.HandleOnce(kNoWait));
  EXPECT_EQ(bus.channels().at("EVENT").num_received, 2);
}

TEST(Bus, CountsMalformedMessagesAndGoesOn) {
  Bus bus("memq://");
  int num_handled = 0;
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, [&](const event_t&) { ++num_handled; });
  bus.PublishBytes("EVENT", "rubbish", 7);
  bus.Publish("EVENT", command_t{});
  bus.Publish("EVENT", Event(1));
  HandleAll(&bus);
  EXPECT_EQ(num_handled, 1);
  EXPECT_EQ(bus.channels().at("EVENT").num_malformed, 2);
  EXPECT_EQ(bus.channels().at("EVENT").num_received, 1);
}

TEST(Bus, CountsFailedPublishes) {
  Bus bus("memq://");
  event_t event = Event(1);
  bus.PublishBytes("EVENT", nullptr, std::size_t{1} << 32);
  EXPECT_EQ(bus.num_publish_failures(), 1);
  bus.Publish("EVENT", event);
  EXPECT_EQ(bus.num_publish_failures(), 1);
  EXPECT_EQ(bus.num_published(), 1);
}

TEST(Bus, RefusesImpossibleChannels) {
  Bus bus("memq://");
  const auto ignore = [](const event_t&) {};
  EXPECT_THROW(bus.Subscribe<event_t>("", Queue::kEvery, ignore), std::invalid_argument);
  EXPECT_THROW(bus.Subscribe<event_t>(std::string(64, 'A'), Queue::kEvery, ignore),
               std::invalid_argument);
  bus.Subscribe<event_t>("EVENT", Queue::kEvery, ignore);
  EXPECT_THROW(bus.Subscribe<command_t>("EVENT", Queue::kEvery, [](const command_t&) {}),
               std::logic_error);
}

std::string ProblemAt(const std::string& url) {
  try {
    Bus bus(url);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

// LCM itself says no more than a warning to a misspelt option, and large messages get lost.
TEST(Bus, RefusesAUrlThatLcmWouldPassOver) {
  EXPECT_EQ(ProblemAt("carrier-pigeon://"),
            "LCM URL 'carrier-pigeon://' must begin with udpm://, tcpq://, memq:// or file://");
  EXPECT_THAT(ProblemAt("udpm://239.255.76.67:7667?rcv_buf_size=1"),
              HasSubstr("must have no option \"rcv_buf_size\""));
}

TEST(Bus, NamesTheRemedyWhenLcmCannotBeOpened) {
  EXPECT_THAT(ProblemAt("file:///nowhere/raw.lcm"), HasSubstr("is it a readable LCM log?"));
}

TEST(BusLosses, AreTheGapsInTheNumbers) {
  EXPECT_EQ(LossesOf({5, 6, 7}), 0);
  EXPECT_EQ(LossesOf({5, 8, 9, 11}), 2 + 1);
}

TEST(BusLosses, AreNotSeenInARestartOrInUnnumberedMessages) {
  EXPECT_EQ(LossesOf({100, 101, 1, 2, 3}), 0);
  EXPECT_EQ(LossesOf({0, 0, 0}), 0);
  EXPECT_EQ(LossesOf({INT64_MAX, INT64_MIN, INT64_MIN + 1}), 0);
}

TEST(BusLosses, AreBoundedWhateverTheNumbers) { EXPECT_GT(LossesOf({INT64_MIN, INT64_MAX}), 0); }

TEST(BusLosses, AreNotCountedWhereOnlyTheLatestIsWanted) {
  EXPECT_EQ(LossesOf({1, 5, 9}, Queue::kState), 0);
}

TEST(SequenceOf, KnowsWhichTypesCarryANumber) {
  pointcloud2_t cloud{};
  cloud.seq = 7;
  EXPECT_EQ(SequenceOf(cloud), 7);
  EXPECT_EQ(SequenceOf(Event(8)), 8);
  EXPECT_EQ(SequenceOf(ToMessage(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0)), 0, 9)), 9);
  EXPECT_EQ(SequenceOf(samples_t{}), std::nullopt);
  EXPECT_EQ(SequenceOf(module_status_t{}), std::nullopt);  // many senders on one channel
}

TEST(SequenceOf, IgnoresImageMetadataThatIsNoNumber) {
  image_t image{};
  EXPECT_EQ(SequenceOf(image), std::nullopt);
  for (const std::string text : {"", "12x", "99999999999999999999", " 1"}) {
    image_metadata_t entry{};
    entry.key = kImageSeqKey;
    entry.value.assign(text.begin(), text.end());
    image.metadata = {entry};
    EXPECT_EQ(SequenceOf(image), std::nullopt) << text;
  }
}

TEST(ReceiveBufferWarning, NamesTheRemedyWhenTheKernelCapsTheBuffer) {
  const auto warning = ReceiveBufferWarning(kDefaultLcmUrl, 212992);
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, HasSubstr("sysctl -w net.core.rmem_max=4194304"));
}

TEST(ReceiveBufferWarning, AsksForABufferSize) {
  const auto warning = ReceiveBufferWarning("udpm://239.255.76.67:7667?ttl=0", 1 << 30);
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, HasSubstr("recv_buf_size=4194304"));
}

TEST(ReceiveBufferWarning, IsSilentWhereNothingIsWrong) {
  EXPECT_FALSE(ReceiveBufferWarning(kDefaultLcmUrl, 4194304));
  EXPECT_FALSE(ReceiveBufferWarning(kDefaultLcmUrl, std::nullopt));
  EXPECT_FALSE(ReceiveBufferWarning("memq://", 0));
}

}  // namespace
}  // namespace voqcal
