#include "core/guidance/weakest_pair.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

PairNeed Without(const std::string& from, const std::string& to, int num_samples) {
  PairNeed pair;
  pair.from = from;
  pair.to = to;
  pair.num_samples = num_samples;
  return pair;
}

PairNeed With(const std::string& from, const std::string& to, Grade grade, double worst_error) {
  PairNeed pair = Without(from, to, 10);
  pair.grade = grade;
  pair.worst_error = worst_error;
  return pair;
}

PairNeed Enough(PairNeed pair) {
  pair.is_enough = true;
  return pair;
}

TEST(WeakestPair, OfNoPairsIsNone) { EXPECT_FALSE(WeakestPair({}, {})); }

TEST(WeakestPair, AtFirstIsTheFirstAndThenTheOneThatHasBegun) {
  EXPECT_EQ(WeakestPair({Without("roof", "front", 0), Without("roof", "left", 0)}, {}), 0U);
  EXPECT_EQ(WeakestPair({Without("roof", "front", 0), Without("roof", "left", 2)}, 0), 1U);
}

TEST(WeakestPair, HasNoResultOrElseTheLowestVerdictOrElseTheLargestError) {
  const PairNeed good = With("roof", "front", Grade::kGood, 90);
  const PairNeed look = With("roof", "left", Grade::kLook, 30);
  const PairNeed bad = With("roof", "rear", Grade::kBad, 20);
  EXPECT_EQ(WeakestPair({good, look, bad, Without("roof", "right", 0)}, {}), 3U);
  EXPECT_EQ(WeakestPair({good, look, bad}, {}), 2U);
  EXPECT_EQ(WeakestPair({good, look}, {}), 1U);
  EXPECT_EQ(WeakestPair({With("roof", "front", Grade::kLook, 12), look}, {}), 1U);
}

TEST(WeakestPair, WhatHasEnoughNeedsLessThanWhatHasNot) {
  const PairNeed bad = Enough(With("roof", "front", Grade::kBad, 4));
  const PairNeed good = With("roof", "left", Grade::kGood, 6);
  EXPECT_EQ(WeakestPair({bad, good}, {}), 1U);
  EXPECT_EQ(WeakestPair({bad, Enough(good)}, {}), 0U);
}

TEST(WeakestPair, AnErrorThatIsNotKnownIsTheLargest) {
  const PairNeed unknown = With("roof", "left", Grade::kLook, std::nan(""));
  EXPECT_EQ(WeakestPair({With("roof", "front", Grade::kLook, 1e3), unknown}, {}), 1U);
}

TEST(WeakestPair, IsNoneThatSawNoBoardAndThatOthersJoin) {
  const std::vector<PairNeed> pairs = {With("roof", "front", Grade::kLook, 9),
                                       With("roof", "rear", Grade::kLook, 9),
                                       With("bumper", "front", Grade::kLook, 20),
                                       Without("bumper", "rear", 0)};
  EXPECT_EQ(WeakestPair(pairs, {}), 2U);
  std::vector<PairNeed> seen = pairs;
  seen[3].num_samples = 1;  // then they do see the same
  EXPECT_EQ(WeakestPair(seen, {}), 3U);
  std::vector<PairNeed> apart = pairs;
  apart[2] = Without("bumper", "front", 0);
  EXPECT_EQ(WeakestPair(apart, {}), 2U);
}

TEST(WeakestPair, StaysWhileNoOtherNeedsMuchMore) {
  const PairNeed front = With("roof", "front", Grade::kLook, 10);
  EXPECT_EQ(WeakestPair({front, With("roof", "left", Grade::kLook, 20)}, 0), 0U);
  EXPECT_EQ(WeakestPair({front, With("roof", "left", Grade::kLook, 21)}, 0), 1U);
  EXPECT_EQ(WeakestPair({front, With("roof", "left", Grade::kBad, 11)}, 0), 1U);
  EXPECT_EQ(WeakestPair({Enough(front), With("roof", "left", Grade::kLook, 11)}, 0), 1U);
  // Until it has a result, if it has begun.
  EXPECT_EQ(WeakestPair({Without("roof", "front", 2), Without("roof", "left", 3)}, 0), 0U);
}

}  // namespace
}  // namespace voqcal
