#include "sample_collector/clock_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

constexpr std::int64_t kFrameUs = 100'000;

/// Frames of both sensors in turn, the camera's clock so far ahead.
void Feed(int num_frames, std::int64_t begin_us, std::int64_t camera_ahead_us, ClockWatch* watch) {
  for (int i = 0; i < num_frames; ++i) {
    watch->TakeLidar(begin_us + i * kFrameUs);
    watch->TakeCamera(begin_us + i * kFrameUs + camera_ahead_us);
  }
}

TEST(ClockWatch, TellsHowFarClocksAreApart) {
  ClockWatch watch;
  Feed(10, 0, -3'600'000'000, &watch);
  EXPECT_THAT(watch.CameraAheadS(), Optional(DoubleNear(-3600, 0.2)));
  EXPECT_EQ(watch.Trouble().rfind("The camera's clock is 3600", 0), 0u) << watch.Trouble();
}

TEST(ClockWatch, IsContentWithOneClock) {
  ClockWatch watch;
  Feed(10, 0, 40'000, &watch);  // a frame is exposed while a sweep is under way
  EXPECT_EQ(watch.Trouble(), "");
}

TEST(ClockWatch, APauseOfOneSensorIsNoDifference) {
  ClockWatch watch;
  Feed(10, 0, 0, &watch);
  for (int i = 10; i < 200; ++i) watch.TakeLidar(i * kFrameUs);
  EXPECT_EQ(watch.Trouble(), "");
  Feed(10, 200 * kFrameUs, 0, &watch);
  EXPECT_EQ(watch.Trouble(), "");
}

TEST(ClockWatch, FramesThatPairAreOfOneClockHoweverLateTheyCome) {
  ClockWatch watch;
  for (int i = 0; i < 10; ++i) {
    Feed(1, i * kFrameUs, -4'000'000, &watch);
    watch.NotePair();
  }
  EXPECT_EQ(watch.Trouble(), "");
}

TEST(ClockWatch, FollowsAClockThatJumpsAndIsSetRight) {
  ClockWatch watch;
  Feed(10, 0, 0, &watch);
  Feed(4, 10 * kFrameUs, 5'000'000, &watch);
  EXPECT_NE(watch.Trouble(), "");
  Feed(4, 14 * kFrameUs, 0, &watch);
  EXPECT_EQ(watch.Trouble(), "");
}

}  // namespace
}  // namespace voqcal
