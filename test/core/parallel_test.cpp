#include "core/parallel.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/with_helpers.hpp"

namespace voqcal {
namespace {

using ::testing::Each;

TEST(ParallelFor, DoesEachOnceWhateverTheNumberOfThreads) {
  for (const std::size_t num_helpers : {0, 1, 5}) {
    const test::WithHelpers helpers(num_helpers);
    std::vector<int> num_done(1000);
    ParallelFor(num_done.size(), [&](std::size_t i) { ++num_done[i]; });
    EXPECT_THAT(num_done, Each(1)) << num_helpers;
  }
}

TEST(ParallelFor, WorksWithinWork) {
  const test::WithHelpers helpers(3);
  std::vector<std::vector<int>> num_done(20, std::vector<int>(20));
  ParallelFor(num_done.size(), [&](std::size_t i) {
    ParallelFor(num_done[i].size(), [&](std::size_t k) { ++num_done[i][k]; });
  });
  for (const std::vector<int>& row : num_done) EXPECT_THAT(row, Each(1));
}

TEST(ParallelFor, IsHelped) {
  const test::WithHelpers helpers(1);
  std::atomic<int> num_there{0};
  ParallelFor(2, [&](std::size_t) {
    ++num_there;
    while (num_there < 2) std::this_thread::yield();  // for ever, if one comes after the other
  });
  EXPECT_EQ(num_there, 2);
}

TEST(ParallelFor, NeverDoesMoreAtOnceThanTold) {
  const test::WithHelpers helpers(3);
  std::atomic<int> num_now{0};
  std::atomic<bool> are_too_many{false};
  ParallelFor(
      200,
      [&](std::size_t) {
        if (++num_now > 2) are_too_many = true;
        std::this_thread::yield();
        --num_now;
      },
      2);
  EXPECT_FALSE(are_too_many);
}

TEST(ParallelFor, WithinWorkDoesNoMoreAtOnceThanThereAreThreads) {
  const test::WithHelpers helpers(3);
  std::atomic<int> num_now{0};
  std::atomic<bool> are_too_many{false};
  ParallelFor(30, [&](std::size_t) {
    ParallelFor(10, [&](std::size_t) {
      if (++num_now > 4) are_too_many = true;
      std::this_thread::yield();
      --num_now;
    });
  });
  EXPECT_FALSE(are_too_many);
}

TEST(ParallelFor, ThrowsWhatTheFirstThrowsAfterAllHaveEnded) {
  const test::WithHelpers helpers(3);
  std::atomic<int> num_done{0};
  try {
    ParallelFor(100, [&](std::size_t i) {
      ++num_done;
      if (i >= 40) throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "40");
  }
  EXPECT_EQ(num_done, 100);
}

}  // namespace
}  // namespace voqcal
