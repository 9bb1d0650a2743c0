#include "dashboard/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;

TEST(ParsePageRequest, ReadsEachCommand) {
  for (const std::string command : {"capture", "discard", "finish", "reset"}) {
    const auto request = ParsePageRequest("{\"command\": \"" + command + "\"}");
    ASSERT_TRUE(request) << request.error();
    EXPECT_EQ(request->command, command);
    EXPECT_EQ(request->sample_id, 0);
  }
}

TEST(ParsePageRequest, ReadsWhichSampleToDiscard) {
  const auto request = ParsePageRequest(R"({"command": "discard", "sample_id": 17})");
  ASSERT_TRUE(request) << request.error();
  EXPECT_EQ(request->sample_id, 17);
}

TEST(ParsePageRequest, ReadsWhatIsDrawn) {
  EXPECT_EQ(ParsePageRequest(R"({"shown": "image"})")->shown, Slot::kImage);
  EXPECT_EQ(ParsePageRequest(R"({"shown": "cloud"})")->shown, Slot::kCloud);
  EXPECT_EQ(ParsePageRequest(R"({"shown": "cloud"})")->command, "");
}

TEST(ParsePageRequest, ReadsWhichPairIsMeantOrWatched) {
  const auto request =
      ParsePageRequest(R"({"command": "discard", "sample_id": 17, "pair": "roof_front"})");
  ASSERT_TRUE(request) << request.error();
  EXPECT_EQ(request->pair, "roof_front");
  EXPECT_EQ(request->watch, "");
  EXPECT_EQ(ParsePageRequest(R"({"watch": "roof_front"})")->watch, "roof_front");
}

TEST(ParsePageRequest, RefusesAllElseWithAReason) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "no JSON"},
      {"capture", "no JSON"},
      {R"({"command": "capture")", "no JSON"},
      {R"({"command": "capture"} {})", "no JSON"},
      {"{\"command\": \"\xff\"}", "no JSON"},
      {"[]", "no JSON object"},
      {"null", "no JSON object"},
      {"{}", "none of"},
      {R"({"Command": "capture"})", "none of"},
      {R"({"command": "shutdown"})", "must be"},
      {R"({"command": 7})", "must be"},
      {R"({"command": ["capture"]})", "must be"},
      {R"({"command": "capture", "force": true})", "unknown keys"},
      {R"({"command": "capture", "sample_id": 1})", "sample_id"},
      {R"({"command": "discard", "sample_id": -1})", "sample_id"},
      {R"({"command": "discard", "sample_id": 1.5})", "sample_id"},
      {R"({"command": "discard", "sample_id": "1"})", "sample_id"},
      {R"({"command": "discard", "sample_id": 18446744073709551615})", "sample_id"},
      {R"({"command": "discard", "sample_id": 1, "x": 1})", "unknown keys"},
      {R"({"command": "capture", "pair": 1})", "name of a pair"},
      {R"({"command": "reset", "pair": ""})", "name of a pair"},
      {R"({"command": "capture", "pair": "a", "x": 1})", "unknown keys"},
      {R"({"watch": 1})", "name of a pair"},
      {R"({"watch": ""})", "name of a pair"},
      {R"({"watch": "a", "command": "reset"})", "alone"},
      {R"({"shown": "samples"})", "must be"},
      {R"({"shown": 1})", "must be"},
      {R"({"shown": "image", "command": "reset"})", "alone"}};
  for (const auto& [text, reason] : cases) {
    const auto request = ParsePageRequest(text);
    ASSERT_FALSE(request) << text;
    EXPECT_THAT(request.error(), HasSubstr(reason)) << text;
  }
}

TEST(ParsePageRequest, RefusesWhatIsTooLong) {
  const std::string text = R"({"command": "capture"})" + std::string(kMaxRequestBytes, ' ');
  EXPECT_THAT(ParsePageRequest(text).error(), HasSubstr("too long"));
}

TEST(ParsePageRequest, SurvivesDeepNesting) {
  EXPECT_FALSE(ParsePageRequest(std::string(kMaxRequestBytes, '[')));
}

}  // namespace
}  // namespace voqcal
