#include "voq_selector/voq_selector_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modules/nodes/chain_test.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class VoqSelectorNodeTest : public test::ChainTest {
 protected:
  const std::vector<voq_sets_t>& sent() const { return inbox_.messages; }

  VoqSelectorNode node_{rig_, &bus_};
  test::Inbox<voq_sets_t> inbox_{&bus_, rig_.channels.voq_sets};
};

TEST_F(VoqSelectorNodeTest, ChoosesTheSetsOfLowestVoq) {
  SendSamples(test::NoisySamples(10), 4);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(sent()[0].samples_revision, 4);
  EXPECT_EQ(sent()[0].problem, "");
  EXPECT_EQ(sent()[0].num_combinations, 120);  // 10 over 3
  ASSERT_EQ(sent()[0].num_sets, 50);
  for (std::size_t i = 1; i < sent()[0].sets.size(); ++i) {
    EXPECT_LE(sent()[0].sets[i - 1].voq, sent()[0].sets[i].voq);
  }
  EXPECT_EQ(node_.State(), "running");
}

TEST_F(VoqSelectorNodeTest, CountsSamplesThatContradictThemselvesAndGoesOn) {
  test::Send(&bus_, rig_.channels.calib_samples, BrokenSamples(1));
  Step(&node_);
  Step(&node_);
  EXPECT_THAT(sent(), IsEmpty());
  EXPECT_EQ(node_.counters().at("unreadable message"), 1);
  SendSamples(test::NoisySamples(4), 2);
  Step(&node_);
  EXPECT_THAT(sent(), SizeIs(1));
}

TEST_F(VoqSelectorNodeTest, LeavesOutASampleThatDisagreesAndNamesIt) {
  test::SyntheticSamplesOptions options;
  options.num_samples = 10;
  options.num_outliers = 1;  // the first
  SendSamples(test::SynthesizeSamples(options), 1);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_THAT(sent()[0].inconsistent_ids, ElementsAre(1));
  EXPECT_THAT(sent()[0].inconsistent_reasons, ElementsAre(Not(IsEmpty())));
  EXPECT_EQ(sent()[0].num_combinations, 84);  // 9 over 3
  for (const voq_set_t& set : sent()[0].sets) {
    EXPECT_THAT(set.sample_ids, ::testing::Each(::testing::Ne(1)));
  }
}

TEST_F(VoqSelectorNodeTest, TakesTheRunnerUpThatFitsAndSaysSo) {
  std::vector<BoardSample> samples = test::NoisySamples(10);
  LidarBoard other = samples[3].lidar;
  other.pose.centre_m += Eigen::Vector3d(0.5, 1.0, 0.0);
  samples[3].runners_up = {samples[3].lidar};
  samples[3].lidar = other;
  SendSamples(samples, 1);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_THAT(sent()[0].inconsistent_ids, IsEmpty());
  ASSERT_EQ(sent()[0].num_chosen, 1);
  EXPECT_EQ(sent()[0].chosen[0].sample_id, 4);
  EXPECT_EQ(sent()[0].chosen[0].candidate, 1);
  EXPECT_THAT(sent()[0].chosen[0].reason, HasSubstr("disagrees with"));
  EXPECT_EQ(sent()[0].num_combinations, 120);
}

TEST_F(VoqSelectorNodeTest, ListsTheLowestVoqWhateverTheCriterion) {
  Rig rig = rig_;
  rig.voq_selector.criterion = SelectionCriterion::kAllPoses;
  VoqSelectorNode all_poses(rig, &bus_);
  SendSamples(test::NoisySamples(10), 1);
  Step(&node_);
  Step(&all_poses);
  ASSERT_THAT(sent(), SizeIs(2));
  EXPECT_EQ(sent()[0].criterion, "voq");
  EXPECT_EQ(sent()[1].criterion, "all_poses");
  ASSERT_EQ(sent()[1].num_sets, 1);
  EXPECT_THAT(sent()[1].sets[0].sample_ids, SizeIs(10));
  ASSERT_EQ(sent()[1].num_lowest_voq, 50);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(sent()[1].lowest_voq[i].sample_ids, sent()[0].sets[i].sample_ids);
    EXPECT_EQ(sent()[1].lowest_voq[i].voq, sent()[0].sets[i].voq);
  }
}

TEST_F(VoqSelectorNodeTest, SaysThatSamplesAreTooFew) {
  SendSamples({}, 0);
  Step(&node_);
  SendSamples(test::NoisySamples(2), 2);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(2));
  EXPECT_THAT(sent()[0].problem, HasSubstr("fewer than three samples"));
  EXPECT_THAT(sent()[1].problem, HasSubstr("fewer than three samples"));
  EXPECT_THAT(sent()[1].sets, IsEmpty());
  EXPECT_THAT(node_.State(), HasSubstr("waiting: fewer than three"));
}

TEST_F(VoqSelectorNodeTest, SaysThatBoardsAreParallel) {
  test::SyntheticSamplesOptions options;
  options.num_samples = 6;
  options.max_tilt_rad = 0;
  SendSamples(test::SynthesizeSamples(options), 6);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_THAT(sent()[0].problem, HasSubstr("all boards face the same way"));
}

TEST_F(VoqSelectorNodeTest, ComputesARevisionOnce) {
  Step(&node_);  // no samples yet
  EXPECT_THAT(sent(), IsEmpty());
  SendSamples(test::NoisySamples(5), 5);
  Step(&node_);
  SendSamples(test::NoisySamples(5), 5);  // the collector's repetition
  Step(&node_);
  EXPECT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(node_.counters(), (test::Counters{{"selections", 1}}));
  node_.Republish();
  test::HandleAll(&bus_);
  EXPECT_THAT(sent(), SizeIs(2));
  SendSamples(test::NoisySamples(6), 6);
  Step(&node_);
  EXPECT_EQ(sent().back().samples_revision, 6);
}

TEST_F(VoqSelectorNodeTest, ComputesAnotherSessionsSamplesOfTheSameRevision) {
  SendSamples(test::NoisySamples(5), 5, "one log");
  Step(&node_);
  SendSamples(test::NoisySamples(4), 5, "another log");
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(2));
  EXPECT_EQ(sent()[0].samples_sha256, "one log");
  EXPECT_EQ(sent()[1].samples_sha256, "another log");
  EXPECT_EQ(sent()[1].num_combinations, 4);
}

}  // namespace
}  // namespace voqcal
