#include "messaging/session_name.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/bus.hpp"
#include "messaging/encode.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;

TEST(SessionName, IsOfHostAndFolder) {
  EXPECT_THAT(SessionName("/a/b/../c"), ::testing::EndsWith(":/a/c"));
  EXPECT_EQ(SessionName("").back(), ':');
}

TEST(SessionName, IsTheSameBeforeTheFolderIsThereAndHoweverItIsWritten) {
  const test::TemporaryFolder folder;
  const auto here = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const std::string before = SessionName("new/");
  std::filesystem::create_directory("new");
  EXPECT_EQ(SessionName("new"), before);
  EXPECT_EQ(SessionName(folder.path() / "new"), before);
  std::filesystem::current_path(here);
}

TEST(MayBeOf, TakesItsOwnAndItsPairs) {
  EXPECT_TRUE(MayBeOf("robot:/s", "robot:/s"));
  EXPECT_TRUE(MayBeOf("robot:/s", "robot:/s/roof_front"));
  EXPECT_TRUE(MayBeOf("robot:/s/roof_front", "robot:/s"));
  EXPECT_FALSE(MayBeOf("robot:/s", "robot:/s2"));
  EXPECT_FALSE(MayBeOf("robot:/s", "desk:/s"));
  EXPECT_FALSE(MayBeOf("robot:/s/roof_front", "robot:/s/roof_rear"));
}

TEST(MayBeOf, TakesAllWhereOneIsOfNone) {
  for (const char* none : {"", "robot:"}) {
    EXPECT_TRUE(MayBeOf(none, "desk:/s"));
    EXPECT_TRUE(MayBeOf("desk:/s", none));
  }
}

/// Publishes as another process of this session would.
template <typename Message>
void PublishFrom(const std::string& session, Message message, Bus* bus) {
  message.session = session;
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  bus->PublishBytes(Message::getTypeName(), bytes.data(), bytes.size());
  bus->HandleWaiting();
}

TEST(BusOfASession, TakesNoStateOfAnother) {
  Bus bus("memq://");
  std::vector<std::string> taken;
  bus.Subscribe<samples_t>("samples_t", Queue::kState, [&taken](const samples_t& message) {
    taken.push_back(message.session);
  });
  PublishFrom("desk:/s", samples_t{}, &bus);
  bus.SetSession("robot:/s");
  PublishFrom("desk:/s", samples_t{}, &bus);
  PublishFrom("robot:/s", samples_t{}, &bus);
  EXPECT_THAT(taken, ElementsAre("desk:/s", "robot:/s"));
  EXPECT_EQ(bus.channels().at("samples_t").num_received, 2);
  EXPECT_EQ(bus.channels().at("samples_t").num_foreign, 1);
}

TEST(BusOfASession, NamesItInWhatItPublishes) {
  Bus bus("memq://");
  bus.SetSession("robot:/s");
  std::string session;
  bus.Subscribe<samples_t>("SAMPLES", Queue::kState, [&session](const samples_t& message) {
    session = message.session;
  });
  bus.Publish("SAMPLES", samples_t{});
  bus.HandleWaiting();
  EXPECT_EQ(session, "robot:/s");
}

TEST(BusOfASession, HearsTheHeartbeatsOfAll) {
  Bus bus("memq://");
  bus.SetSession("robot:/s");
  std::vector<std::string> heard;
  bus.Subscribe<module_status_t>(
      "module_status_t", Queue::kEvery, [&heard](const module_status_t& message) {
        heard.push_back(message.session);
      });
  PublishFrom("desk:/s", module_status_t{}, &bus);
  EXPECT_THAT(heard, ElementsAre("desk:/s"));
}

}  // namespace
}  // namespace voqcal
