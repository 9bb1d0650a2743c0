#include "sample_collector/frame_buffer.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(FrameBuffer, FindsTheLatestFrameOfATime) {
  FrameBuffer frames(100);
  frames.Add({1, {10}});
  frames.Add({2, {20}});
  frames.Add({1, {11}});  // a driver that was started again
  ASSERT_NE(frames.Find(1), nullptr);
  EXPECT_EQ(frames.Find(1)->bytes, std::vector<std::uint8_t>{11});
  EXPECT_EQ(frames.Find(3), nullptr);
}

TEST(FrameBuffer, ForgetsTheOldestBeyondItsSize) {
  FrameBuffer frames(5);
  frames.Add({1, {1, 1}});
  frames.Add({2, {2, 2}});
  EXPECT_NE(frames.Find(1), nullptr);
  frames.Add({3, {3, 3}});
  EXPECT_EQ(frames.Find(1), nullptr);
  EXPECT_NE(frames.Find(2), nullptr);
  frames.Add({4, {4, 4, 4, 4, 4, 4}});  // alone too large
  EXPECT_EQ(frames.Find(4), nullptr);
}

TEST(FrameBuffer, ForgetsWhatCameBeforeTheJudgedFrameButForWhatIsInUse) {
  FrameBuffer frames(100);
  for (std::int64_t utime = 1; utime <= 5; ++utime) frames.Add({utime, {1, 2}});
  frames.ForgetJudged(4, {2});
  EXPECT_EQ(frames.Find(1), nullptr);
  EXPECT_NE(frames.Find(2), nullptr);
  EXPECT_EQ(frames.Find(3), nullptr);
  EXPECT_NE(frames.Find(4), nullptr);
  EXPECT_NE(frames.Find(5), nullptr);
  EXPECT_EQ(frames.num_bytes(), 6U);
}

TEST(FrameBuffer, KeepsAllWhereTheJudgedFrameDidNotArrive) {
  FrameBuffer frames(100);
  frames.Add({1, {1}});
  frames.Add({3, {3}});
  frames.ForgetJudged(2, {});
  EXPECT_NE(frames.Find(1), nullptr);
  EXPECT_NE(frames.Find(3), nullptr);
}

// A recording that is played again: its first frames come before the last ones of before are
// judged.
TEST(FrameBuffer, ForgetsNothingThatCameAfterTheJudgedFrame) {
  FrameBuffer frames(100);
  for (const std::int64_t utime : {8, 9, 1, 2}) frames.Add({utime, {1}});
  frames.ForgetJudged(9, {});
  EXPECT_EQ(frames.Find(8), nullptr);
  EXPECT_NE(frames.Find(1), nullptr);
  EXPECT_NE(frames.Find(2), nullptr);
  EXPECT_EQ(frames.NewestUtime(), 2);
}

}  // namespace
}  // namespace voqcal
