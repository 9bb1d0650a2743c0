#include "rig_calibrator/rig_calibrator_node.hpp"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "messaging/convert_result.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/matchers.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/next_pose_t.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Rig PairOf(const std::string& lidar, const std::string& camera) {
  Rig rig = test::TestRig();
  rig.rig_name = "truck";
  rig.lidar_name = lidar;
  rig.camera_name = camera;
  rig.channels.calib_samples += "_" + lidar + "_" + camera;
  rig.channels.next_pose += "_" + lidar + "_" + camera;
  return rig;
}

/// One lidar, two cameras.
class RigCalibratorNodeTest : public ::testing::Test {
 protected:
  void Send(std::size_t pair, const samples_t& message) {
    bus_.Publish(pairs_[pair].channels.calib_samples, message);
    test::HandleAll(&bus_);
  }
  void Send(std::size_t pair, int num_samples, std::int64_t revision) {
    Send(pair, ToMessage(test::NoisySamples(num_samples), revision, false, "hash"));
  }
  /// Lets the node work until it has nothing to do.
  void Work() {
    do {
      node_.Step();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (node_.NextStep());
    test::HandleAll(&bus_);
  }
  bool HasFile(const std::string& name) const {
    return std::filesystem::exists(folder_.path() / name);
  }
  const rig_extrinsics_t& newest() const { return results_.messages.back(); }

  test::TemporaryFolder folder_;
  std::vector<Rig> pairs_ = {PairOf("front", "left"), PairOf("front", "right")};
  Bus bus_{"memq://"};
  RigCalibratorNode node_{pairs_, &bus_, folder_.path()};
  test::Inbox<rig_extrinsics_t> results_{&bus_, "RIG_EXTRINSICS"};
};

TEST_F(RigCalibratorNodeTest, SaysWhatToJoinUntilAllPairsHoldTheRig) {
  EXPECT_EQ(node_.State(), "waiting for samples");
  Send(0, 8, 8);
  Work();
  EXPECT_THAT(newest().problem,
              HasSubstr("no pair joins these parts of the rig: front, left | right"));
  EXPECT_EQ(newest().num_sensors, 0);
  EXPECT_THAT(newest().pairs,
              ElementsAre(Field(&rig_pair_t::problem, IsEmpty()),
                          Field(&rig_pair_t::problem, Eq("not calibrated yet"))));
  EXPECT_TRUE(HasFile("front_left/extrinsic.yaml"));
  EXPECT_FALSE(HasFile("rig_extrinsics.yaml"));

  Send(1, 10, 10);
  Work();
  EXPECT_EQ(newest().problem, "");
  EXPECT_EQ(newest().revision, 2);
  EXPECT_THAT(newest().sensors,
              ElementsAre(Field(&rig_sensor_t::name, "front"),
                          Field(&rig_sensor_t::name, "left"),
                          Field(&rig_sensor_t::name, "right")));
  EXPECT_EQ(newest().num_rows, 18);
  EXPECT_EQ(newest().pairs[1].samples_revision, 10);
  EXPECT_THAT(newest().advice, HasSubstr("Show the board to " + newest().weakest_pair));
  EXPECT_THAT(ReadWholeFile(folder_.path() / "rig_extrinsics.yaml"),
              HasSubstr("\nreference: front"));
  EXPECT_EQ(node_.State(), "running: 2 of 2 pairs have an extrinsic");
}

TEST_F(RigCalibratorNodeTest, SaysOfAPairWhatItsOwnModulesWould) {
  const test::Inbox<assessment_t> assessments(&bus_, "CALIB_ASSESSMENT");
  Send(1, 8, 8);
  Work();
  ASSERT_THAT(assessments.messages, ::testing::SizeIs(1));
  EXPECT_EQ(assessments.messages[0].samples_revision, 8);
  EXPECT_EQ(assessments.messages[0].num_samples, newest().pairs[1].num_samples);
}

TEST_F(RigCalibratorNodeTest, GuidesEachPairAndSendsToTheOneThatNeedsSamplesMost) {
  const test::Inbox<next_pose_t> of_left(&bus_, "NEXT_POSE_front_left");
  const test::Inbox<next_pose_t> of_right(&bus_, "NEXT_POSE_front_right");
  Send(0, 8, 8);
  Send(1, 0, 1);
  Work();
  ASSERT_FALSE(of_left.messages.empty());
  ASSERT_FALSE(of_right.messages.empty());
  EXPECT_EQ(of_left.messages.back().samples_revision, 8);
  EXPECT_EQ(newest().weakest_pair, "front_right");
  EXPECT_EQ(newest().advice, "Show the board to front_right: " + of_right.messages.back().advice);
  Send(1, 8, 2);
  Send(0, 0, 9);  // a reset
  Work();
  EXPECT_EQ(newest().weakest_pair, "front_left");
  EXPECT_EQ(of_left.messages.back().samples_revision, 9);
}

TEST_F(RigCalibratorNodeTest, WorksOnTheNewestSamplesAloneAndOnThemOnce) {
  for (int num = 5; num <= 9; ++num) Send(0, num, num);
  Work();
  EXPECT_EQ(newest().pairs[0].samples_revision, 9);
  EXPECT_EQ(newest().revision, 1);
  Send(0, 9, 9);  // again, as once a second
  Work();
  EXPECT_EQ(newest().revision, 1);
}

TEST_F(RigCalibratorNodeTest, AnEarlierTreeIsNotLeftBesideSamplesThatGiveNone) {
  Send(0, 8, 8);
  Send(1, 8, 8);
  Work();
  ASSERT_TRUE(HasFile("rig_extrinsics.yaml"));
  Send(1, 0, 9);  // a reset
  Work();
  EXPECT_THAT(newest().problem, HasSubstr("front, left | right"));
  EXPECT_FALSE(HasFile("rig_extrinsics.yaml"));
  EXPECT_FALSE(HasFile("front_right/extrinsic.yaml"));
}

TEST_F(RigCalibratorNodeTest, StartedAgainItKeepsTheRigsFileUntilEveryPairWasWorkedOn) {
  folder_.Write("rig_extrinsics.yaml", "of before");
  Send(0, 8, 8);
  Work();
  EXPECT_EQ(ReadWholeFile(folder_.path() / "rig_extrinsics.yaml"), "of before");
  Send(1, 8, 8);
  Work();
  EXPECT_THAT(ReadWholeFile(folder_.path() / "rig_extrinsics.yaml"),
              HasSubstr("\nreference: front"));
}

TEST_F(RigCalibratorNodeTest, APairThatWaitsIsToldWithItsSamples) {
  Send(0, 8, 8);
  Send(1, 9, 9);
  node_.Republish();
  test::HandleAll(&bus_);
  EXPECT_EQ(newest().pairs[0].num_samples, 8);
  EXPECT_EQ(newest().pairs[1].num_samples, 9);
  EXPECT_EQ(newest().pairs[1].problem, "not calibrated yet");
}

TEST_F(RigCalibratorNodeTest, CountsARevisionForEachChangeOfWhatItSays) {
  const auto say = [this] {
    node_.Republish();
    test::HandleAll(&bus_);
    return newest();
  };
  const rig_extrinsics_t first = say();
  EXPECT_EQ(first.advice, "Show the board to front_left.");
  EXPECT_EQ(say().revision, first.revision);
  Send(1, 9, 9);  // not calibrated yet, but the weakest is the one that has begun
  const rig_extrinsics_t second = say();
  EXPECT_EQ(second.weakest_pair, "front_right");
  EXPECT_EQ(second.revision, first.revision + 1);
  EXPECT_EQ(say().revision, second.revision);
}

TEST_F(RigCalibratorNodeTest, OrdersNoBoardShownWhereItKnowsNoPlace) {
  std::vector<Rig> blind = pairs_;
  for (Rig& rig : blind)
    rig.pose_guide.limits.max_distance_m = rig.pose_guide.limits.min_distance_m = 1e4;
  const test::TemporaryFolder folder;
  Bus bus("memq://");
  RigCalibratorNode node(blind, &bus, folder.path());
  const test::Inbox<rig_extrinsics_t> results(&bus, "RIG_EXTRINSICS");
  for (const Rig& rig : blind) {
    test::Send(&bus, rig.channels.calib_samples, ToMessage({}, 1, false, "hash"));
  }
  do {
    node.Step();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (node.NextStep());
  test::HandleAll(&bus);
  EXPECT_THAT(results.messages.back().advice,
              ::testing::StartsWith("front_left: nowhere can the board be held"));
}

TEST_F(RigCalibratorNodeTest, AMessageThatContradictsItselfIsCounted) {
  samples_t broken = ToMessage(test::NoisySamples(4), 4, false, "hash");
  broken.samples[0].lidar.num_points = 1;
  broken.samples[0].lidar.points.assign(1, std::vector<float>(4));
  broken.samples[0].lidar.num_rings = 2;
  broken.samples[0].lidar.rings.resize(2);
  Send(0, broken);
  Work();
  EXPECT_EQ(node_.counters().at("unreadable message"), 1);
  EXPECT_EQ(results_.messages.size(), 0U);
}

}  // namespace
}  // namespace voqcal
