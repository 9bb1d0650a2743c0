#include "core/scene/scene_check.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr double kDeg = M_PI / 180.0;

/// A simulated room with pillars, seen at the rig's stops by a VLP-16 and a small camera.
class CheckSceneTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SimulationOptions options;
    options.T_camera_lidar = test::TestExtrinsic();
    options.num_poses = 6;
    options.max_distance_m = 3.0;
    const Simulation simulation(options, test::TestBoard(), Camera());
    views_ = std::make_unique<std::vector<SceneView>>();
    for (int stop = 0; stop < options.num_poses; ++stop) {
      const double time_s = stop * (options.hold_s + options.move_s) + options.hold_s / 2;
      BoardSample sample;
      const Eigen::Isometry3d T_lidar_board = simulation.T_lidar_board(time_s);
      sample.lidar.pose = PoseFromTransform(T_lidar_board, test::TestBoard());
      sample.camera.pose =
          PoseFromTransform(test::TestExtrinsic() * T_lidar_board, test::TestBoard());
      views_->push_back(MakeSceneView(simulation.Sweep(time_s),
                                      simulation.Image(time_s),
                                      sample,
                                      test::TestBoard(),
                                      Camera(),
                                      {}));
    }
  }
  static void TearDownTestSuite() { views_.reset(); }

  static CameraModel Camera() { return test::SmallCamera(LensModel::kEquidistant); }
  static Eigen::Isometry3d Turned(double x_deg, double y_deg, double z_deg) {
    Vector6d delta = Vector6d::Zero();
    delta.head<3>() = kDeg * Eigen::Vector3d(x_deg, y_deg, z_deg);
    return PerturbLeft(test::TestExtrinsic(), delta);
  }
  static SceneCheck Check(const Eigen::Isometry3d& T_camera_lidar) {
    return CheckScene(*views_, Camera(), T_camera_lidar, {});
  }

  static std::unique_ptr<std::vector<SceneView>> views_;
};

std::unique_ptr<std::vector<SceneView>> CheckSceneTest::views_;

TEST_F(CheckSceneTest, DoesNotContradictTheTruth) {
  const SceneCheck check = Check(test::TestExtrinsic());
  EXPECT_NE(check.verdict, Agreement::kDisagrees) << check.reason;
  EXPECT_EQ(check.num_scenes, 6);
  EXPECT_GT(check.score, 0.7);  // 0.5 is chance
  // A pixel of the camera is 0.14 deg; the pillars say little of the turn about x.
  EXPECT_NE(check.axes[1], Agreement::kDisagrees) << check.reason;
  EXPECT_LT(std::abs(check.asked[1]), 0.14 * kDeg);
}

TEST_F(CheckSceneTest, DisagreesWithATurnAndSaysByHowMuch) {
  const SceneCheck check = Check(Turned(0, 0.8, 0));
  EXPECT_EQ(check.verdict, Agreement::kDisagrees) << check.reason;
  EXPECT_GT(check.asked_score, check.score + 0.1);
  EXPECT_NEAR(check.asked[1], -0.8 * kDeg, 0.2 * kDeg);
  EXPECT_THAT(check.reason, HasSubstr("fit best when turned by"));
  // The turned axis is named, and not the one that the room's lines leave open.
  EXPECT_EQ(check.axes[1], Agreement::kDisagrees) << check.reason;
  EXPECT_EQ(check.axes[0], Agreement::kCannotTell) << check.reason;
}

// Between scan lines that are 2 deg apart the surprise has hollows that all parts of a scene share:
// curvature and scatter are sure of them. What is asked must gain more than such hollows do.
TEST_F(CheckSceneTest, IsNotFooledByHollowsBetweenScanLines) {
  int num_sure = 0;
  for (std::size_t left_out = 0; left_out < views_->size(); ++left_out) {
    std::vector<SceneView> views = *views_;
    views.erase(views.begin() + static_cast<std::ptrdiff_t>(left_out));
    const SceneCheck check = CheckScene(views, Camera(), test::TestExtrinsic(), {});
    EXPECT_NE(check.verdict, Agreement::kDisagrees) << "without " << left_out << check.reason;
    num_sure += std::abs(check.asked[0]) > 3 * check.sigma[0] ? 1 : 0;
  }
  EXPECT_GE(num_sure, 3);  // or this room has no such hollows, and the test shows nothing
}

// An axis known no better than asked for is left open, and named.
TEST_F(CheckSceneTest, LeavesOpenWhatItKnowsTooLittleOf) {
  SceneCheckOptions options;
  options.max_turn_sigma_rad = 1e-6;
  options.max_shift_sigma_m = 1e-6;
  const SceneCheck check = CheckScene(*views_, Camera(), test::TestExtrinsic(), options);
  EXPECT_EQ(check.verdict, Agreement::kCannotTell);
  EXPECT_THAT(check.reason, HasSubstr("it shows too little of turns about x, turns about y"));
}

TEST_F(CheckSceneTest, ScoresEachPerturbationBelowTheTruth) {
  const SceneCheck check = Check(test::TestExtrinsic());
  ASSERT_THAT(check.probes, SizeIs(6 * 2 * 4));
  int num_lower = 0;
  for (const SceneProbe& probe : check.probes) {
    num_lower += probe.score < check.score ? 1 : 0;
    const bool is_large =
        probe.delta.head<3>().norm() > 0.9 * kDeg || probe.delta.tail<3>().norm() > 0.09;
    if (is_large) {
      EXPECT_LT(probe.score, check.score) << probe.delta.transpose();
    }
  }
  EXPECT_GE(num_lower, 40);  // of 48: the smallest steps along weak axes may not show
}

TEST_F(CheckSceneTest, SameViewsSameAnswer) {
  const SceneCheck one = Check(Turned(0.3, -0.2, 0.1));
  const SceneCheck two = Check(Turned(0.3, -0.2, 0.1));
  EXPECT_EQ(one.score, two.score);
  EXPECT_EQ(one.asked, two.asked);
  EXPECT_EQ(one.reason, two.reason);
}

TEST_F(CheckSceneTest, DoesNotJudgeWithoutScenesOrEdges) {
  const SceneCheck none = CheckScene({}, Camera(), test::TestExtrinsic(), {});
  EXPECT_EQ(none.verdict, Agreement::kCannotTell);
  EXPECT_THAT(none.reason, HasSubstr("no scene"));
  std::vector<SceneView> empty = *views_;
  for (SceneView& view : empty) view.edges.clear();
  const SceneCheck no_edges = CheckScene(empty, Camera(), test::TestExtrinsic(), {});
  EXPECT_EQ(no_edges.verdict, Agreement::kCannotTell);
  EXPECT_THAT(no_edges.reason, HasSubstr("only 0 depth edges"));
}

TEST_F(CheckSceneTest, DoesNotJudgeByImagesThatShowOtherThings) {
  std::vector<SceneView> others = *views_;
  test::Random random(5);
  for (SceneView& view : others) {  // noise: every pixel's rank by chance
    view.edge_rank = view.edge_rank.clone();
    for (int i = 0; i < view.edge_rank.rows * view.edge_rank.cols; ++i) {
      view.edge_rank.data[i] = static_cast<uchar>(1 + random.Index(255));
    }
  }
  const SceneCheck check = CheckScene(others, Camera(), test::TestExtrinsic(), {});
  EXPECT_EQ(check.verdict, Agreement::kCannotTell) << check.reason;
  EXPECT_NEAR(check.score, 0.5, 0.05);
}

TEST(MakeSceneView, TakesTheNearerSideOfAJumpHalfWayToTheNextRay) {
  // One scan line: a wall at 2 m ends between azimuths 0.1 and 0.104, then one at 4 m.
  PointCloud cloud;
  for (int i = 0; i < 50; ++i) {
    const double azimuth_rad = 0.004 * i;
    const double range_m = i <= 25 ? 2.0 : 4.0;
    LidarPoint point;
    point.position_m =
        (range_m * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0)).cast<float>();
    cloud.points.push_back(point);
  }
  BoardSample sample;  // far from the wall
  Eigen::Isometry3d T_sensor_board = Eigen::Isometry3d::Identity();
  T_sensor_board.translation() = Eigen::Vector3d(-5, 0, 0);
  sample.lidar.pose = PoseFromTransform(T_sensor_board, test::TestBoard());
  sample.camera.pose = sample.lidar.pose;
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  const cv::Mat image(camera.height_px, camera.width_px, CV_8U, cv::Scalar(90));
  const SceneView view = MakeSceneView(cloud, image, sample, test::TestBoard(), camera, {});
  ASSERT_THAT(view.edges, SizeIs(1));
  EXPECT_NEAR(view.edges[0].position_lidar_m.norm(), 2.0, 1e-5);
  EXPECT_NEAR(std::atan2(view.edges[0].position_lidar_m.y(), view.edges[0].position_lidar_m.x()),
              0.102,
              1e-5);
}

TEST(MakeSceneView, LeavesTheBoardOut) {
  const BoardSpec board = test::TestBoard();
  PointCloud cloud;  // the board at 2 m before a wall at 4 m
  for (int i = -50; i < 50; ++i) {
    const double azimuth_rad = 0.004 * i;
    const double range_m = std::abs(i) < 30 ? 2.0 : 4.0;
    LidarPoint point;
    point.position_m =
        (range_m * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0)).cast<float>();
    cloud.points.push_back(point);
  }
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  T_lidar_board.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;  // facing the lidar
  T_lidar_board.translation() = Eigen::Vector3d(2, 0, 0);
  BoardSample sample;
  sample.lidar.pose = PoseFromTransform(T_lidar_board, board);
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.translation() = Eigen::Vector3d(0, 0, 2);
  sample.camera.pose = PoseFromTransform(T_camera_board, board);
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  cv::Mat image(camera.height_px, camera.width_px, CV_8U, cv::Scalar(90));
  const SceneView view = MakeSceneView(cloud, image, sample, board, camera, {});
  EXPECT_THAT(view.edges, ::testing::IsEmpty());
  EXPECT_EQ(view.edge_rank.at<uchar>(197, 322), 0);  // the board hides the background here
  EXPECT_NE(view.edge_rank.at<uchar>(5, 5), 0);
}

TEST(MakeSceneView, RefusesAnImageOfAnotherSize) {
  const cv::Mat image(10, 10, CV_8U, cv::Scalar(0));
  EXPECT_THROW(
      MakeSceneView(
          {}, image, {}, test::TestBoard(), test::SmallCamera(LensModel::kEquidistant), {}),
      std::invalid_argument);
}

TEST(SceneCheckOptions, NamesEachProblem) {
  SceneCheckOptions options;
  options.turn_tolerance_rad = 0;
  options.view.edges.min_jump_m = -1;
  EXPECT_THAT(options.Problems(),
              ::testing::ElementsAre("min_jump_m must be positive, is -1",
                                     "turn_tolerance_rad must be positive, is 0"));
}

}  // namespace
}  // namespace voqcal
