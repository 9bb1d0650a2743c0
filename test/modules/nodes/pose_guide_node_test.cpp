#include "pose_guide/pose_guide_node.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/encode.hpp"
#include "modules/nodes/chain_test.hpp"
#include "support/matchers.hpp"
#include "voq_selector/voq_selector_node.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

class PoseGuideTest : public test::ChainTest {
 protected:
  void StepAll() {
    Step(&selector_);
    Step(&estimator_);
    Step(&refiner_);
    Step(&guide_);
  }
  const std::vector<next_pose_t>& poses() const { return poses_.messages; }

  VoqSelectorNode selector_{rig_, &bus_};
  ExtrinsicEstimatorNode estimator_{rig_, &bus_};
  ExtrinsicRefinerNode refiner_{rig_, &bus_};
  PoseGuideNode guide_{rig_, &bus_};
  test::Inbox<extrinsic_averaged_t> averages_{&bus_, rig_.channels.extrinsic_averaged};
  test::Inbox<extrinsic_refined_t> refinements_{&bus_, rig_.channels.extrinsic_refined};
  test::Inbox<next_pose_t> poses_{&bus_, rig_.channels.next_pose};
};

// One board in both frames, and in the image.
void ExpectOneBoard(const next_pose_t& next, const Eigen::Isometry3d& T_camera_lidar) {
  const Eigen::Isometry3d T_camera_board = FromMessage(next.T_camera_board);
  EXPECT_THAT(T_camera_lidar * FromMessage(next.T_lidar_board),
              test::IsNear(T_camera_board, 1e-9, 1e-9));
  const auto outline_board_m = test::TestBoard().OutlineBoardM();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Map<const Eigen::Vector3d> in_camera_m(next.corners_camera_m[i]);
    const Eigen::Map<const Eigen::Vector3d> in_lidar_m(next.corners_lidar_m[i]);
    const Eigen::Map<const Eigen::Vector2d> pixel_px(next.corners_px[i]);
    EXPECT_LT((T_camera_board * outline_board_m[i] - in_camera_m).norm(), 1e-9);
    EXPECT_LT((T_camera_lidar * in_lidar_m - in_camera_m).norm(), 1e-9);
    EXPECT_LT((test::TestCamera().Project(Eigen::Vector3d(in_camera_m)) - pixel_px).norm(), 1e-9);
  }
}

TEST_F(PoseGuideTest, AsksForAPoseBeforeTheFirstSample) {
  EXPECT_THAT(guide_.State(), HasSubstr("waiting for samples"));
  SendSamples({}, 0);
  Step(&guide_);
  ASSERT_THAT(poses(), SizeIs(1));
  EXPECT_EQ(poses()[0].problem, "");
  EXPECT_THAT(poses()[0].advice, StartsWith("Hold the board "));
  EXPECT_TRUE(std::isinf(poses()[0].worst_error));
  EXPECT_FALSE(poses()[0].is_enough);
  EXPECT_FALSE(poses()[0].is_lidar_known);
  EXPECT_EQ(guide_.State(), "running");
}

TEST_F(PoseGuideTest, NeedsNoExtrinsicForTheFirstTwoSamples) {
  SendSamples(test::NoisySamples(1), 1);
  Step(&guide_);
  SendSamples(test::NoisySamples(2), 2);
  Step(&guide_);
  ASSERT_THAT(poses(), SizeIs(2));
  EXPECT_TRUE(poses()[1].is_lidar_known);
  EXPECT_TRUE(std::isfinite(poses()[1].worst_error));
}

TEST_F(PoseGuideTest, CountsSamplesThatContradictThemselvesAndGoesOn) {
  samples_t few = BrokenSamples(1);
  few.samples.resize(2);
  few.num_samples = 2;
  test::Send(&bus_, rig_.channels.calib_samples, few);
  Step(&guide_);
  EXPECT_THAT(poses(), IsEmpty());
  EXPECT_EQ(guide_.counters().at("unreadable message"), 1);
  SendSamples(test::NoisySamples(2), 2);
  Step(&guide_);
  EXPECT_THAT(poses(), SizeIs(1));
}

TEST_F(PoseGuideTest, GoesByTheRefinedExtrinsicOfTheSameSamples) {
  SendSamples(test::NoisySamples(6), 6, "the log");
  Step(&guide_);
  EXPECT_THAT(poses(), IsEmpty());
  StepAll();
  ASSERT_THAT(poses(), SizeIs(1));
  const next_pose_t& next = poses()[0];
  EXPECT_EQ(next.samples_revision, 6);
  EXPECT_EQ(next.samples_sha256, "the log");
  EXPECT_EQ(next.utime, 6'000'000);
  EXPECT_EQ(next.problem, "");
  EXPECT_EQ(next.unit, "mm");
  EXPECT_EQ(next.tolerance, 5.0);
  EXPECT_EQ(next.max_range_m, 5.0);
  EXPECT_GT(next.worst_error, next.predicted_worst_error);
  ExpectOneBoard(next, FromMessage(refinements_.messages[0].T_camera_lidar));
  EXPECT_EQ(guide_.counters(), (test::Counters{{"proposals", 1}}));
}

TEST_F(PoseGuideTest, GoesByTheAverageWhereThereIsNoRefiner) {
  SendSamples(test::NoisySamples(6), 6);
  Step(&selector_);
  Step(&estimator_);
  Step(&guide_);
  ASSERT_THAT(poses(), SizeIs(1));
  EXPECT_EQ(poses()[0].problem, "");
  EXPECT_FALSE(poses()[0].is_enough);
  ExpectOneBoard(poses()[0], FromMessage(averages_.messages[0].T_camera_lidar));
}

// A process that was started again may hear the average first.
TEST_F(PoseGuideTest, EndsUpTheSameHoweverTheExtrinsicsArrive) {
  rig_.pose_guide.enough.tolerance.tolerance = 1000.0;
  PoseGuideNode both_at_once(rig_, &bus_);
  PoseGuideNode one_by_one(rig_, &bus_);
  SendSamples(test::NoisySamples(8), 8);
  Step(&selector_);
  Step(&estimator_);
  Step(&one_by_one);
  ASSERT_THAT(poses(), SizeIs(1));
  EXPECT_FALSE(poses()[0].is_enough);
  Step(&refiner_);
  Step(&one_by_one);
  Step(&both_at_once);
  ASSERT_THAT(poses(), SizeIs(3));
  EXPECT_TRUE(poses()[1].is_enough);
  EXPECT_EQ(EncodeMessage(poses()[1]), EncodeMessage(poses()[2]));
  Step(&one_by_one);
  EXPECT_THAT(poses(), SizeIs(3));  // and no more
}

TEST_F(PoseGuideTest, SaysEnough) {
  rig_.pose_guide.enough.tolerance.tolerance = 1000.0;
  PoseGuideNode easy(rig_, &bus_);
  SendSamples(test::NoisySamples(8), 8);
  Step(&selector_);
  Step(&estimator_);
  Step(&refiner_);
  Step(&easy);
  ASSERT_THAT(poses(), SizeIs(1));
  EXPECT_TRUE(poses()[0].is_enough);
  EXPECT_THAT(poses()[0].advice, StartsWith("Enough: "));
}

TEST_F(PoseGuideTest, SaysWhenNoPoseIsInBothViews) {
  rig_.pose_guide.sensors.min_elevation_rad = 1.0;
  rig_.pose_guide.sensors.max_elevation_rad = 1.2;
  PoseGuideNode blind(rig_, &bus_);
  SendSamples({}, 0);
  Step(&blind);
  ASSERT_THAT(poses(), SizeIs(1));
  EXPECT_THAT(poses()[0].problem, HasSubstr("view of camera and lidar"));
  EXPECT_THAT(blind.State(), HasSubstr("waiting: nowhere"));
  EXPECT_EQ(blind.counters(), (test::Counters{{"without a pose", 1}}));
}

TEST_F(PoseGuideTest, ComputesOnceAndRepublishes) {
  SendSamples(test::NoisySamples(5), 5);
  StepAll();
  SendSamples(test::NoisySamples(5), 5);
  refiner_.Republish();
  StepAll();
  ASSERT_THAT(poses(), SizeIs(1));
  guide_.Republish();
  test::HandleAll(&bus_);
  ASSERT_THAT(poses(), SizeIs(2));
  EXPECT_EQ(poses()[1].T_camera_board.translation_m[2], poses()[0].T_camera_board.translation_m[2]);
}

// A process that was killed hears the same state again within a second, and says the same again.
TEST_F(PoseGuideTest, StartedAgainSaysTheSame) {
  SendSamples(test::NoisySamples(5), 5);
  StepAll();
  PoseGuideNode restarted(rig_, &bus_);
  SendSamples(test::NoisySamples(5), 5);
  estimator_.Republish();
  refiner_.Republish();
  test::HandleAll(&bus_);
  Step(&restarted);
  ASSERT_THAT(poses(), SizeIs(2));
  EXPECT_EQ(poses()[1].advice, poses()[0].advice);
  EXPECT_EQ(FromMessage(poses()[1].T_camera_board).matrix(),
            FromMessage(poses()[0].T_camera_board).matrix());
}

// A session begun anew, with fewer samples.
TEST_F(PoseGuideTest, FollowsADiscardedSession) {
  SendSamples(test::NoisySamples(5), 5);
  StepAll();
  SendSamples({}, 6);
  Step(&guide_);
  ASSERT_THAT(poses(), SizeIs(2));
  EXPECT_EQ(poses()[1].samples_revision, 6);
  EXPECT_FALSE(poses()[1].is_lidar_known);
}

}  // namespace
}  // namespace voqcal
