#include "core/parallel.hpp"

#include <algorithm>
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

TEST(ParallelFor, NeverDoesMoreAtOnceThanToldOrThereAreThreads) {
  const test::WithHelpers helpers(3);
  for (const std::size_t most_at_once : {2, 100}) {
    std::atomic<std::size_t> num_now{0};
    std::atomic<bool> are_too_many{false};
    const auto work = [&] {
      if (++num_now > std::min<std::size_t>(most_at_once, 4)) are_too_many = true;
      std::this_thread::yield();
      --num_now;
    };
    ParallelFor(
        30,
        [&](std::size_t) {
          ParallelFor(
              10, [&](std::size_t) { work(); }, 1);
        },
        most_at_once);
    EXPECT_FALSE(are_too_many) << most_at_once;
  }
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
