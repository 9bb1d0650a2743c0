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

TEST(WeakestPair, IsLastOneThatOthersJoin) {
  const std::vector<PairNeed> pairs = {Enough(With("roof", "front", Grade::kLook, 3)),
                                       Enough(With("roof", "rear", Grade::kLook, 4)),
                                       Enough(With("bumper", "front", Grade::kGood, 2)),
                                       Without("bumper", "rear", 9)};
  EXPECT_EQ(WeakestPair(pairs, {}), 1U);
  // Each sensor has a result, but none joins the two halves.
  std::vector<PairNeed> apart = pairs;
  apart[2] = With("bumper", "left", Grade::kGood, 2);
  EXPECT_EQ(WeakestPair(apart, {}), 3U);
}

TEST(WeakestPair, IsNotOneForWhichTheGuideKnowsNoPlace) {
  PairNeed bad = With("roof", "front", Grade::kBad, 50);
  bad.has_place = false;
  EXPECT_EQ(WeakestPair({bad, Enough(With("roof", "rear", Grade::kGood, 2))}, {}), 1U);
  // Unless it is needed to join the rig: then the others that would come first.
  PairNeed none = Without("roof", "left", 5);
  none.has_place = false;
  EXPECT_EQ(WeakestPair({none, With("roof", "rear", Grade::kBad, 50)}, {}), 0U);
  EXPECT_EQ(WeakestPair({none, Without("roof", "rear", 0)}, {}), 1U);
}

// Samples are not compared with errors.
TEST(WeakestPair, WhatHasAResultButNoPlaceComesBeforeWhatOthersJoin) {
  PairNeed stuck = Enough(With("roof", "front", Grade::kGood, 2));
  stuck.is_enough = stuck.has_place = false;
  EXPECT_EQ(WeakestPair({Without("roof", "front", 50), stuck}, {}), 1U);
}

TEST(WeakestPair, IsNotOneThatCannotBeSampled) {
  PairNeed dead = Without("roof", "rear", 9);
  dead.can_be_sampled = false;
  PairNeed bad = With("roof", "left", Grade::kBad, 50);
  bad.can_be_sampled = false;
  const PairNeed enough = Enough(With("roof", "front", Grade::kGood, 2));
  EXPECT_EQ(WeakestPair({dead, bad, enough}, {}), 2U);
  EXPECT_EQ(WeakestPair({dead, bad, enough}, 1), 2U);
  EXPECT_EQ(WeakestPair({dead, bad, Without("bumper", "left", 0)}, {}), 2U);
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
