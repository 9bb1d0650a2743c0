#include "lidar_board_detector/lidar_board_detector_node.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/convert_board.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class LidarBoardDetectorNodeTest : public ::testing::Test {
 protected:
  void Send(const pointcloud2_t& message) {
    test::Send(&bus_, rig_.channels.lidar_points, message);
  }
  const std::vector<lidar_board_t>& found() const { return inbox_.messages; }

  Rig rig_ = test::TestRig();
  Bus bus_{"memq://"};
  LidarBoardDetectorNode node_{rig_, &bus_};
  test::Inbox<lidar_board_t> inbox_{&bus_, rig_.channels.lidar_board};
};

PointCloud BoardAtTwoMetres(Eigen::Isometry3d* T_lidar_board) {
  test::SyntheticLidarBoardOptions scene;
  scene.board = test::TestBoard();
  scene.T_lidar_board = test::FacingBoard({2.0, 0.2, 0.0}, 45, 20, -10);
  *T_lidar_board = scene.T_lidar_board;
  return test::SynthesizeLidarBoard(scene);
}

TEST_F(LidarBoardDetectorNodeTest, PublishesTheBoardOfASweep) {
  Eigen::Isometry3d T_lidar_board;
  Send(ToMessage(BoardAtTwoMetres(&T_lidar_board), 1234567, 8));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].utime, 1234567);
  EXPECT_EQ(found()[0].frame, "lidar");
  EXPECT_EQ(found()[0].miss, "");
  const LidarSighting sighting = SightingFromMessage(found()[0]);
  ASSERT_TRUE(sighting.board);
  // Within the step between beams: 2 degrees of elevation at 2 m are 70 mm; many rings average it.
  EXPECT_LT((sighting.board->pose.centre_m - T_lidar_board.translation()).norm(), 0.02);
  EXPECT_EQ(node_.counters(), (test::Counters{{"boards", 1}}));
}

TEST_F(LidarBoardDetectorNodeTest, AnswersAnEmptyCloudWithTheReason) {
  Send(ToMessage(PointCloud{}, 5, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].utime, 5);
  EXPECT_EQ(found()[0].num_candidates, 0);
  EXPECT_EQ(found()[0].miss, "too few points");
  EXPECT_EQ(node_.counters(), (test::Counters{{"too few points", 1}}));
}

TEST_F(LidarBoardDetectorNodeTest, AnswersACloudOfNanWithTheReason) {
  PointCloud cloud;
  cloud.points.resize(5000);
  for (LidarPoint& point : cloud.points) {
    point.position_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  Send(ToMessage(cloud, 5, 0));
  ASSERT_THAT(found(), SizeIs(1));
  EXPECT_EQ(found()[0].miss, "too few points");
}

TEST_F(LidarBoardDetectorNodeTest, CountsACloudThatContradictsItselfAndGoesOn) {
  Eigen::Isometry3d T_lidar_board;
  const pointcloud2_t good = ToMessage(BoardAtTwoMetres(&T_lidar_board), 2, 1);
  pointcloud2_t broken = good;
  broken.width += 1000;  // more points than bytes
  Send(broken);
  Send(good);
  ASSERT_THAT(found(), SizeIs(2));
  EXPECT_THAT(found()[0].miss, Not(IsEmpty()));
  EXPECT_EQ(found()[1].miss, "");
  EXPECT_EQ(node_.counters(),
            (test::Counters{{"boards", 1},
                            {"point cloud message: row_step is N but a row has N bytes", 1}}));
}

TEST_F(LidarBoardDetectorNodeTest, LearnsTheBackgroundFromEarlierSweeps) {
  test::SyntheticLidarBoardOptions scene;
  scene.board = test::TestBoard();
  test::SyntheticBox poster;
  poster.T_lidar_box = test::FacingBoard({2.3, -1.2, -0.1}, 40.0);
  poster.half_m = {scene.board.width_m / 2, scene.board.height_m / 2, 0.001};
  scene.boxes.push_back(poster);
  scene.T_lidar_board = test::FacingBoard({2.3, 0.6, -0.1}, 40.0, 10.0);
  scene.has_board = false;
  Send(ToMessage(test::SynthesizeLidarBoard(scene), 1, 0));
  scene.has_board = true;
  Send(ToMessage(test::SynthesizeLidarBoard(scene), 2, 1));
  ASSERT_THAT(found(), SizeIs(2));
  const LidarSighting sighting = SightingFromMessage(found()[1]);
  ASSERT_TRUE(sighting.board) << found()[1].miss;
  EXPECT_LT((sighting.board->pose.centre_m - scene.T_lidar_board.translation()).norm(), 0.02);
}

TEST_F(LidarBoardDetectorNodeTest, NumbersItsMessages) {
  for (int i = 0; i < 3; ++i) Send(ToMessage(PointCloud{}, i, i));
  ASSERT_THAT(found(), SizeIs(3));
  EXPECT_EQ(found()[1].seq, found()[0].seq + 1);
  EXPECT_EQ(found()[2].seq, found()[1].seq + 1);
}

}  // namespace
}  // namespace voqcal
