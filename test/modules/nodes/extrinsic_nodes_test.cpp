// The estimator and the refiner, fed by the stages before them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "messaging/convert_result.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/matchers.hpp"
#include "voq_selector/voq_selector_node.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// What solvers leave of an exact answer.
constexpr double kExactRad = 1e-6;
constexpr double kExactM = 1e-6;

std::vector<BoardSample> ExactSamples(int num_samples) {
  test::SyntheticSamplesOptions options;
  options.num_samples = num_samples;
  return test::SynthesizeSamples(options);
}

class ExtrinsicNodesTest : public test::ChainTest {
 protected:
  void StepAll() {
    Step(&selector_);
    Step(&estimator_);
    Step(&refiner_);
  }
  const std::vector<extrinsic_averaged_t>& averaged() const { return averages_.messages; }
  const std::vector<extrinsic_refined_t>& refined() const { return refinements_.messages; }

  VoqSelectorNode selector_{rig_, &bus_};
  ExtrinsicEstimatorNode estimator_{rig_, &bus_};
  ExtrinsicRefinerNode refiner_{rig_, &bus_};
  test::Inbox<voq_sets_t> sets_{&bus_, rig_.channels.voq_sets};
  test::Inbox<extrinsic_averaged_t> averages_{&bus_, rig_.channels.extrinsic_averaged};
  test::Inbox<extrinsic_refined_t> refinements_{&bus_, rig_.channels.extrinsic_refined};
};

TEST_F(ExtrinsicNodesTest, FindTheTruthOfExactSamples) {
  SendSamples(ExactSamples(8), 8);
  StepAll();
  ASSERT_THAT(averaged(), SizeIs(1));
  EXPECT_EQ(averaged()[0].problem, "");
  EXPECT_EQ(averaged()[0].samples_revision, 8);
  EXPECT_EQ(averaged()[0].num_sets, 50);
  EXPECT_THAT(FromMessage(averaged()[0].T_camera_lidar),
              test::IsNear(test::TestExtrinsic(), kExactRad, kExactM));
  ASSERT_THAT(refined(), SizeIs(1));
  EXPECT_EQ(refined()[0].problem, "");
  EXPECT_EQ(refined()[0].samples_revision, 8);
  EXPECT_THAT(refined()[0].sample_ids, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(FromMessage(refined()[0].T_camera_lidar),
              test::IsNear(test::TestExtrinsic(), kExactRad, kExactM));
}

TEST_F(ExtrinsicNodesTest, LeaveTheSelectorsOutlierOutAndPassItsNameOn) {
  test::SyntheticSamplesOptions options;
  options.num_samples = 9;
  options.num_outliers = 1;  // the first
  SendSamples(test::SynthesizeSamples(options), 9);
  StepAll();
  ASSERT_THAT(refined(), SizeIs(1));
  EXPECT_THAT(averaged()[0].inconsistent_ids, ElementsAre(1));
  EXPECT_THAT(refined()[0].sample_ids, ElementsAre(2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_THAT(FromMessage(refined()[0].T_camera_lidar),
              test::IsNear(test::TestExtrinsic(), kExactRad, kExactM));
}

TEST_F(ExtrinsicNodesTest, UseTheCandidateThatTheSelectorChose) {
  std::vector<BoardSample> samples = ExactSamples(9);
  LidarBoard other = samples[2].lidar;
  other.pose = samples[5].lidar.pose;
  samples[2].runners_up = {samples[2].lidar};
  samples[2].lidar = other;
  SendSamples(samples, 9);
  StepAll();
  ASSERT_THAT(refined(), SizeIs(1));
  ASSERT_EQ(averaged()[0].num_chosen, 1);
  EXPECT_EQ(averaged()[0].chosen[0].sample_id, 3);
  EXPECT_THAT(refined()[0].sample_ids, SizeIs(9));
  EXPECT_THAT(FromMessage(averaged()[0].T_camera_lidar),
              test::IsNear(test::TestExtrinsic(), kExactRad, kExactM));
  EXPECT_THAT(FromMessage(refined()[0].T_camera_lidar),
              test::IsNear(test::TestExtrinsic(), kExactRad, kExactM));
}

TEST_F(ExtrinsicNodesTest, SayWhyASetWasDropped) {
  SendSamples(test::NoisySamples(12), 12);
  StepAll();
  ASSERT_THAT(averaged(), SizeIs(1));
  int num_dropped = 0;
  for (const set_extrinsic_t& set : averaged()[0].sets) {
    EXPECT_EQ(set.is_kept != 0, set.reason.empty());
    if (set.is_kept != 0) continue;
    ++num_dropped;
    EXPECT_THAT(set.reason, HasSubstr("standard deviations from the mean of all sets"));
  }
  EXPECT_GT(num_dropped, 0);
}

TEST_F(ExtrinsicNodesTest, PassTheProblemOfTooFewSamplesOn) {
  SendSamples(ExactSamples(2), 2);
  StepAll();
  ASSERT_THAT(averaged(), SizeIs(1));
  ASSERT_THAT(refined(), SizeIs(1));
  EXPECT_THAT(averaged()[0].problem, HasSubstr("fewer than three samples"));
  EXPECT_EQ(refined()[0].problem, averaged()[0].problem);
  EXPECT_THAT(estimator_.State(), HasSubstr("waiting: fewer than three"));
  EXPECT_THAT(refiner_.State(), HasSubstr("waiting: fewer than three"));
  EXPECT_EQ(refiner_.counters(), (test::Counters{{"without a result", 1}}));
}

TEST_F(ExtrinsicNodesTest, CountMessagesThatContradictThemselvesAndGoOn) {
  const auto samples = ExactSamples(8);
  SendSamples(samples, 8);
  Step(&selector_);
  voq_sets_t sets = sets_.messages.back();
  sets.sets[0].sample_ids[0] = 99;
  test::Send(&bus_, rig_.channels.voq_sets, sets);
  Step(&estimator_);
  Step(&estimator_);
  EXPECT_THAT(averaged(), IsEmpty());
  EXPECT_EQ(estimator_.counters().at("unreadable message"), 1);

  SendSamples(samples, 8);  // a second later both come again
  selector_.Republish();
  test::HandleAll(&bus_);
  Step(&estimator_);
  ASSERT_THAT(averaged(), SizeIs(1));
  extrinsic_averaged_t average = averaged()[0];
  average.T_camera_lidar.quaternion_xyzw[3] = 7;
  test::Send(&bus_, rig_.channels.extrinsic_averaged, average);
  Step(&refiner_);
  EXPECT_THAT(refined(), IsEmpty());
  EXPECT_EQ(refiner_.counters().at("unreadable message"), 1);
}

TEST_F(ExtrinsicNodesTest, WaitForMessagesOfTheSameRevision) {
  SendSamples(ExactSamples(5), 5);
  Step(&selector_);
  SendSamples(ExactSamples(6), 6);  // before the estimator came to 5
  Step(&estimator_);
  EXPECT_THAT(averaged(), IsEmpty());
  Step(&selector_);
  Step(&estimator_);
  ASSERT_THAT(averaged(), SizeIs(1));
  EXPECT_EQ(averaged()[0].samples_revision, 6);
  SendSamples(ExactSamples(7), 7);
  Step(&refiner_);
  EXPECT_THAT(refined(), IsEmpty());
}

TEST_F(ExtrinsicNodesTest, DoNotMixSessionsOfTheSameRevision) {
  SendSamples(ExactSamples(5), 5, "one log");
  StepAll();
  SendSamples(ExactSamples(6), 5, "another log");
  Step(&estimator_);
  Step(&refiner_);
  EXPECT_THAT(averaged(), SizeIs(1));  // the sets, and then the average, are still the first log's
  EXPECT_THAT(refined(), SizeIs(1));
  StepAll();
  ASSERT_THAT(refined(), SizeIs(2));
  EXPECT_EQ(averaged()[1].samples_sha256, "another log");
  EXPECT_EQ(refined()[1].samples_sha256, "another log");
  EXPECT_THAT(refined()[1].sample_ids, SizeIs(6));
}

TEST_F(ExtrinsicNodesTest, ComputeARevisionOnce) {
  SendSamples(ExactSamples(5), 5);
  StepAll();
  SendSamples(ExactSamples(5), 5);
  selector_.Republish();
  estimator_.Republish();
  test::HandleAll(&bus_);
  StepAll();
  EXPECT_EQ(estimator_.counters(), (test::Counters{{"estimates", 1}}));
  EXPECT_EQ(refiner_.counters(), (test::Counters{{"refinements", 1}}));
}

TEST_F(ExtrinsicNodesTest, OrderOfArrivalDoesNotMatter) {
  const std::vector<BoardSample> samples = test::NoisySamples(8);
  SendSamples(samples, 8);
  StepAll();
  ASSERT_THAT(refined(), SizeIs(1));

  Bus bus("memq://");
  ExtrinsicEstimatorNode estimator(rig_, &bus);
  ExtrinsicRefinerNode refiner(rig_, &bus);
  test::Inbox<extrinsic_refined_t> refinements(&bus, rig_.channels.extrinsic_refined);
  test::Send(&bus, rig_.channels.extrinsic_averaged, averaged()[0]);
  test::Send(&bus, rig_.channels.voq_sets, sets_.messages[0]);
  refiner.Step();
  estimator.Step();
  test::Send(&bus, rig_.channels.calib_samples, SamplesMessage(samples, 8));
  refiner.Step();  // before the estimator: its own copy of the average has come already
  test::HandleAll(&bus);
  ASSERT_THAT(refinements.messages, SizeIs(1));
  EXPECT_EQ(FromMessage(refinements.messages[0].T_camera_lidar).matrix(),
            FromMessage(refined()[0].T_camera_lidar).matrix());
}

}  // namespace
}  // namespace voqcal
