#include "check_recording/recording_contents.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/encode.hpp"
#include "messaging/sequence.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSecond = 1000000;

std::vector<std::uint8_t> Sweep(int seq) {
  pointcloud2_t sweep{};
  sweep.seq = seq;
  return EncodeMessage(sweep);
}

std::vector<std::uint8_t> Image(int seq) {
  image_t image{};
  image_metadata_t number{};
  const std::string text = std::to_string(seq);
  number.key = kImageSeqKey;
  number.n = static_cast<std::int32_t>(text.size());
  number.value.assign(text.begin(), text.end());
  image.metadata = {number};
  image.nmetadata = 1;
  return EncodeMessage(image);
}

class RecordingContentsTest : public ::testing::Test {
 protected:
  void Write(std::int64_t utime,
             const std::string& channel,
             const std::vector<std::uint8_t>& bytes) {
    LogEvent event;
    event.number = num_++;
    event.utime = utime;
    event.channel = channel;
    event.bytes = bytes;
    writer_.Write(event);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "raw.lcm";
  LogWriter writer_{log_};
  std::int64_t num_ = 0;
};

TEST_F(RecordingContentsTest, NothingIsMissingWhereEveryNumberIsThere) {
  for (int i = 0; i < 11; ++i) {
    Write(i * kSecond / 10, "LIDAR_POINTS", Sweep(i));
    if (i % 2 == 0) Write(i * kSecond / 10, "CAMERA_IMAGE", Image(i / 2));
  }
  Write(kSecond, "OTHER", {1, 2, 3});
  const RecordingContents contents = ContentsOf({log_});
  EXPECT_EQ(contents.Missing(), "");
  EXPECT_EQ(contents.Unknown(), "");
  ASSERT_EQ(contents.channels.size(), 3U);
  EXPECT_EQ(contents.channels.at("LIDAR_POINTS").num_messages, 11);
  EXPECT_NEAR(*contents.channels.at("LIDAR_POINTS").RateHz(), 10.0, 1e-9);
  EXPECT_NEAR(*contents.channels.at("CAMERA_IMAGE").RateHz(), 5.0, 1e-9);
  EXPECT_FALSE(contents.channels.at("OTHER").RateHz().has_value());
  EXPECT_EQ(contents.end_utime - contents.begin_utime, kSecond);
}

TEST_F(RecordingContentsTest, GapsAreCountedByChannel) {
  for (const int i : {0, 1, 4, 5, 7}) Write(i * kSecond, "LIDAR_POINTS#left", Sweep(i));
  for (const int i : {3, 4, 6}) Write(i * kSecond, "CAMERA_IMAGE", Image(i));
  EXPECT_EQ(ContentsOf({log_}).Missing(),
            "CAMERA_IMAGE: 1 of 4 lost, the first 6.0 s after the start; "
            "LIDAR_POINTS#left: 3 of 8 lost, the first 4.0 s after the start");
}

TEST_F(RecordingContentsTest, ADriverThatStartsAnewOrDoesNotNumberLosesNothing) {
  for (const int i : {7, 8, 0, 1}) Write(kSecond, "LIDAR_POINTS", Sweep(i));
  for (int i = 0; i < 3; ++i) Write(kSecond, "OTHER_POINTS", Sweep(0));
  EXPECT_EQ(ContentsOf({log_}).Missing(), "");
  EXPECT_EQ(ContentsOf({log_}).Unknown(), "OTHER_POINTS is not numbered; no images");
}

TEST_F(RecordingContentsTest, LossesBetweenTheLogsOfOneRecordingAreCounted) {
  for (const int i : {0, 1}) Write(i * kSecond, "LIDAR_POINTS", Sweep(i));
  const std::filesystem::path second = folder_.path() / "raw.2.lcm";
  LogWriter(second).Write({0, 5 * kSecond, "LIDAR_POINTS", Sweep(5)});
  EXPECT_EQ(ContentsOf({log_, second}).Missing(),
            "LIDAR_POINTS: 3 of 6 lost, the first 5.0 s after the start");
}

TEST_F(RecordingContentsTest, WhatIsDamagedIsTold) {
  std::vector<std::uint8_t> broken = Sweep(0);
  broken.resize(broken.size() - 1);
  const auto text_of = [](const std::vector<std::uint8_t>& bytes) {
    const std::vector<std::uint8_t> event = EncodeLogEvent({0, 0, "LIDAR_POINTS", bytes});
    return std::string(event.begin(), event.end());
  };
  const std::string last = text_of(Sweep(2));
  std::ofstream(log_, std::ios::binary) << text_of(broken) << text_of(Sweep(1)) << "damage" << last
                                        << last.substr(0, last.size() - 3);
  const std::string missing = ContentsOf({log_}).Missing();
  EXPECT_THAT(missing, HasSubstr("LIDAR_POINTS: 1 unreadable"));
  EXPECT_THAT(missing, HasSubstr("damaged places: 1"));
  EXPECT_THAT(missing, HasSubstr("cut off within a message"));
}

}  // namespace
}  // namespace voqcal
