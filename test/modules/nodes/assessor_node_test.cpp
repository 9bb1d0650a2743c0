#include "assessor/assessor_node.hpp"

#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "files/atomic_file.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/matchers.hpp"
#include "support/temporary_folder.hpp"
#include "voq_selector/voq_selector_node.hpp"

namespace voqcal {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class AssessorNodeTest : public test::ChainTest {
 protected:
  /// All that the assessor reads, without letting it compute.
  void RunStagesBefore(const std::vector<BoardSample>& samples, std::int64_t revision) {
    SendSamples(samples, revision);
    Step(&selector_);
    Step(&estimator_);
    Step(&refiner_);
  }
  const std::vector<assessment_t>& sent() const { return inbox_.messages; }

  test::TemporaryFolder folder_;
  std::filesystem::path session_ = folder_.path() / "session";
  std::filesystem::path file_ = session_ / kResultName;
  VoqSelectorNode selector_{rig_, &bus_};
  ExtrinsicEstimatorNode estimator_{rig_, &bus_};
  ExtrinsicRefinerNode refiner_{rig_, &bus_};
  AssessorNode node_{rig_, &bus_, session_};
  test::Inbox<voq_sets_t> sets_{&bus_, rig_.channels.voq_sets};
  test::Inbox<extrinsic_averaged_t> averages_{&bus_, rig_.channels.extrinsic_averaged};
  test::Inbox<extrinsic_refined_t> refinements_{&bus_, rig_.channels.extrinsic_refined};
  test::Inbox<assessment_t> inbox_{&bus_, rig_.channels.calib_assessment};
};

TEST_F(AssessorNodeTest, ScoresExactSamplesWithNoError) {
  test::SyntheticSamplesOptions options;
  options.num_samples = 8;
  RunStagesBefore(test::SynthesizeSamples(options), 8);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(sent()[0].problem, "");
  EXPECT_EQ(sent()[0].samples_revision, 8);
  EXPECT_THAT(sent()[0].sample_ids, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(sent()[0].held_out_centre_mm, SizeIs(8));
  // What the solver leaves of an exact answer: 1e-6 of a pixel or a millimetre and some.
  EXPECT_THAT(sent()[0].held_out_centre_mm, Each(::testing::Lt(1e-3)));
  EXPECT_LT(sent()[0].refined_in_sample.corner_mm.max, 1e-2);
}

TEST_F(AssessorNodeTest, WritesTheWholeResultAsExtrinsicYaml) {
  RunStagesBefore(test::NoisySamples(8), 8);
  Step(&node_);
  ASSERT_TRUE(node_.result());
  EXPECT_EQ(ReadWholeFile(file_), ToYaml(*node_.result()));
  EXPECT_THAT(ReadExtrinsic(file_), test::IsNear(node_.result()->T_camera_lidar, 1e-9, 1e-9));
  EXPECT_EQ(node_.result()->made_from.log_sha256, "log's hash");
  EXPECT_EQ(node_.result()->made_from.rig_sha256, rig_.sha256);
  // Nothing half-written beside it.
  const auto entries = std::filesystem::directory_iterator(session_);
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST_F(AssessorNodeTest, TakesTheResultAwayWithItsSamples) {
  RunStagesBefore(test::NoisySamples(8), 8);
  Step(&node_);
  ASSERT_TRUE(std::filesystem::exists(file_));
  RunStagesBefore({}, 9);  // as after the command "reset"
  Step(&node_);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(AssessorNodeTest, TakesTheReportOfAnEarlierResultAway) {
  RunStagesBefore(test::NoisySamples(8), 8);
  Step(&node_);
  WriteFileAtomically(session_ / "report.html", "of these samples");
  RunStagesBefore(test::NoisySamples(7), 9);
  Step(&node_);
  EXPECT_FALSE(std::filesystem::exists(session_ / "report.html"));
}

TEST_F(AssessorNodeTest, HeldOutScoresAreWorseThanInSample) {
  RunStagesBefore(test::NoisySamples(30), 30);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_GT(sent()[0].refined_held_out.centre_mm.mean, sent()[0].refined_in_sample.centre_mm.mean);
}

TEST_F(AssessorNodeTest, PassesTheProblemOnAndWritesNothing) {
  RunStagesBefore(test::NoisySamples(2), 2);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_THAT(sent()[0].problem, HasSubstr("fewer than three samples"));
  EXPECT_EQ(node_.problem(), sent()[0].problem);
  EXPECT_FALSE(node_.result());
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(AssessorNodeTest, CountsSamplesThatContradictThemselvesAndGoesOn) {
  RunStagesBefore(test::NoisySamples(8), 8);
  test::Send(&bus_, rig_.channels.calib_samples, BrokenSamples(8));
  Step(&node_);
  EXPECT_THAT(sent(), IsEmpty());
  EXPECT_EQ(node_.counters().at("unreadable message"), 1);
  SendSamples(test::NoisySamples(8), 8);
  Step(&node_);
  EXPECT_THAT(sent(), SizeIs(1));
}

TEST_F(AssessorNodeTest, WaitsForAllThreeOfOneRevision) {
  RunStagesBefore(test::NoisySamples(5), 5);
  SendSamples(test::NoisySamples(6), 6);
  Step(&node_);
  EXPECT_THAT(sent(), IsEmpty());
  Step(&selector_);
  Step(&estimator_);
  Step(&node_);
  EXPECT_THAT(sent(), IsEmpty());  // the refined one is still of 5
  Step(&refiner_);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(sent()[0].samples_revision, 6);
}

TEST_F(AssessorNodeTest, DoesNotMixSessionsOfTheSameRevision) {
  RunStagesBefore(test::NoisySamples(5), 5);
  Step(&node_);
  SendSamples(test::NoisySamples(6), 5, "another log");
  Step(&node_);
  EXPECT_THAT(sent(), SizeIs(1));
  Step(&selector_);
  Step(&estimator_);
  Step(&refiner_);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(2));
  EXPECT_EQ(sent()[1].samples_sha256, "another log");
  EXPECT_EQ(node_.result()->made_from.log_sha256, "another log");
}

TEST_F(AssessorNodeTest, AssessesARevisionOnce) {
  RunStagesBefore(test::NoisySamples(5), 5);
  Step(&node_);
  std::filesystem::remove(file_);
  SendSamples(test::NoisySamples(5), 5);
  Step(&node_);
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_EQ(node_.counters(), (test::Counters{{"assessments", 1}}));
}

TEST_F(AssessorNodeTest, OrderOfArrivalDoesNotMatter) {
  const std::vector<BoardSample> samples = test::NoisySamples(7);
  RunStagesBefore(samples, 7);
  Step(&node_);

  const test::TemporaryFolder other_folder;
  Bus bus("memq://");
  AssessorNode other(rig_, &bus, other_folder.path());
  test::Send(&bus, rig_.channels.extrinsic_refined, refinements_.messages[0]);
  other.Step();
  test::Send(&bus, rig_.channels.extrinsic_averaged, averages_.messages[0]);
  other.Step();
  test::Send(&bus, rig_.channels.calib_samples, SamplesMessage(samples, 7));
  other.Step();
  EXPECT_EQ(ReadWholeFile(other_folder.path() / kResultName), ReadWholeFile(file_));
}

TEST_F(AssessorNodeTest, SaysThatThereIsNoSceneAndWhatItFound) {
  RunStagesBefore(test::NoisySamples(5), 5);
  Step(&node_);
  ASSERT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(sent()[0].scene_check.verdict, "cannot tell");
  EXPECT_THAT(sent()[0].scene_check.reason, HasSubstr("no scene"));
  ASSERT_EQ(sent()[0].num_findings, 1);
  EXPECT_EQ(sent()[0].findings[0].cause, "too few or too similar poses");
  EXPECT_EQ(sent()[0].num_predicted, 6);
  EXPECT_GE(sent()[0].num_image_cells, 1);
  EXPECT_GE(sent()[0].num_ranges, 1);
}

TEST_F(AssessorNodeTest, NamesASessionFolderThatCannotBeMade) {
  const auto in_the_way = folder_.Write("file", "");
  EXPECT_THAT(test::ErrorOf([&] { AssessorNode node(rig_, &bus_, in_the_way / "session"); }),
              HasSubstr((in_the_way / "session").string()));
}

}  // namespace
}  // namespace voqcal
