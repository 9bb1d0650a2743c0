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

}  // namespace
}  // namespace voqcal
