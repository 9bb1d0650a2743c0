#include "calibrate/recording_clocks.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kStartUs = 1700000000000000;

// Ten messages, 0.1 s apart.
std::vector<RecordedTime> Messages(const std::function<double(double)>& stamp_us,
                                   double log_shift_us = 0) {
  std::vector<RecordedTime> messages;
  for (int i = 0; i < 10; ++i) {
    const double utime = static_cast<double>(kStartUs) + 1e5 * i;
    messages.push_back({std::llround(stamp_us(utime)), std::llround(utime + log_shift_us)});
  }
  return messages;
}

const auto kSame = [](double utime) { return utime; };

TEST(JudgeClocks, LeavesOneClockAlone) {
  EXPECT_THAT(JudgeClocks(Messages(kSame), Messages(kSame)).words, IsEmpty());
  EXPECT_THAT(JudgeClocks({}, Messages(kSame)).words, IsEmpty());
  // Folders' drivers count from a time of their own, and do not start together.
  const auto synthetic = [](double utime) { return utime - 1e14; };
  const auto later = [](double utime) { return utime - 1e14 + 2e6; };
  EXPECT_FALSE(JudgeClocks(Messages(synthetic), Messages(later)).use_log_times);
}

TEST(JudgeClocks, TakesLogTimesForOthersAndSaysSo) {
  const auto verdict_of = [](const std::function<double(double)>& stamp_us) {
    return JudgeClocks(Messages(stamp_us, 2e4), Messages(kSame));
  };
  const ClockVerdict boot = verdict_of([](double utime) { return utime - 1.7e15 + 5e6; });
  EXPECT_TRUE(boot.use_log_times);
  EXPECT_THAT(boot.words,
              HasSubstr("the clocks of lidar and camera differ by 53.9 years; log times agree "
                        "within 20 ms: using them (--times stamps forbids that)"));
  EXPECT_THAT(verdict_of([](double utime) { return utime + 37e6; }).words, HasSubstr("37 s"));
  EXPECT_THAT(verdict_of([](double) { return 0.0; }).words, HasSubstr("stand still"));
}

TEST(JudgeClocks, KeepsStampsWhereLogTimesDoNotAgreeEither) {
  const auto late = [](double utime) { return utime + 37e6; };
  const ClockVerdict verdict = JudgeClocks(Messages(late, 2e7), Messages(kSame));
  EXPECT_FALSE(verdict.use_log_times);
  EXPECT_THAT(verdict.words, HasSubstr("nor do the times at which they were recorded agree"));
}

TEST(TakeLogTime, ReplacesTheFirstFieldOfAMessage) {
  LogEvent event{0, 0x0102030405060708, "LIDAR_POINTS", std::vector<std::uint8_t>(20, 0xFF)};
  TakeLogTime(&event);
  EXPECT_EQ(event.bytes[7], 0xFF);
  EXPECT_EQ(event.bytes[8], 1);
  EXPECT_EQ(event.bytes[15], 8);
  EXPECT_EQ(event.bytes[16], 0xFF);
  event.bytes.resize(9);
  TakeLogTime(&event);
}

}  // namespace
}  // namespace voqcal
