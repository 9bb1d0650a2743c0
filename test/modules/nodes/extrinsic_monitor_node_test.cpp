#include "extrinsic_monitor/extrinsic_monitor_node.hpp"

#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simulation/simulation.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/transform_yaml.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr std::int64_t kSecondUs = 1000000;

/// A simulated room, a scene a second, watched in stretches of three seconds.
class ExtrinsicMonitorNodeTest : public ::testing::Test {
 protected:
  static constexpr int kNumScenes = 4;

  static void SetUpTestSuite() {
    SimulationOptions options;
    options.T_camera_lidar = test::TestExtrinsic();
    options.num_poses = kNumScenes;
    options.max_distance_m = 3.0;
    const Simulation simulation(options, test::TestBoard(), Camera());
    sweeps_ = std::make_unique<std::vector<PointCloud>>();
    images_ = std::make_unique<std::vector<cv::Mat>>();
    for (int i = 0; i < kNumScenes; ++i) {
      const double time_s = i * (options.hold_s + options.move_s) + options.hold_s / 2;
      sweeps_->push_back(simulation.Sweep(time_s));
      images_->push_back(simulation.Image(time_s));
    }
  }
  static void TearDownTestSuite() {
    sweeps_.reset();
    images_.reset();
  }

  static CameraModel Camera() { return test::SmallCamera(LensModel::kEquidistant); }

  ExtrinsicMonitorNodeTest() {
    rig_.camera = Camera();
    rig_.extrinsic_monitor.window.window_s = 3.0;
  }

  ExtrinsicMonitorNode MakeNode(double turn_deg) {
    Vector6d turn = Vector6d::Zero();
    turn[1] = turn_deg * kRadPerDeg;
    const auto file = folder_.path() / "extrinsic.yaml";
    WriteFileAtomically(
        file, "T_camera_lidar:\n" + TransformYaml(PerturbLeft(test::TestExtrinsic(), turn), "  "));
    return {rig_, &bus_, file};
  }

  void Send(int scene, std::int64_t utime) {
    const auto i = static_cast<std::size_t>(scene);
    bus_.Publish(rig_.channels.lidar_points, ToMessage((*sweeps_)[i], utime, scene));
    bus_.Publish(rig_.channels.camera_image, ToMessage((*images_)[i], utime + 20000, scene));
    test::HandleAll(&bus_);
  }

  static std::unique_ptr<std::vector<PointCloud>> sweeps_;
  static std::unique_ptr<std::vector<cv::Mat>> images_;
  Rig rig_;
  Bus bus_{"memq://"};
  test::TemporaryFolder folder_;
  test::Inbox<extrinsic_check_t> checks_{&bus_, rig_.channels.extrinsic_check};
};

std::unique_ptr<std::vector<PointCloud>> ExtrinsicMonitorNodeTest::sweeps_;
std::unique_ptr<std::vector<cv::Mat>> ExtrinsicMonitorNodeTest::images_;

TEST_F(ExtrinsicMonitorNodeTest, FindsAKnockInAStretch) {
  ExtrinsicMonitorNode node = MakeNode(0.8);
  EXPECT_THAT(node.State(), StartsWith("waiting"));
  for (int i = 0; i < kNumScenes; ++i) {
    EXPECT_FALSE(node.Step());
    Send(i, (1 + i) * kSecondUs);
  }
  EXPECT_TRUE(node.Step());
  test::HandleAll(&bus_);
  ASSERT_THAT(checks_.messages, SizeIs(1));
  const extrinsic_check_t& check = checks_.messages[0];
  EXPECT_EQ(check.check.verdict, "disagrees");
  EXPECT_EQ(check.first_utime, kSecondUs);
  EXPECT_EQ(check.last_utime, 4 * kSecondUs);
  EXPECT_EQ(check.check.num_scenes, kNumScenes);
  EXPECT_NEAR(check.check.asked[1], -0.8 * kRadPerDeg, 0.25 * kRadPerDeg);
  EXPECT_THAT(node.State(), AllOf(StartsWith("trouble: "), HasSubstr("calibrate again")));
  EXPECT_FALSE(node.Step());  // the next stretch has just begun
}

TEST_F(ExtrinsicMonitorNodeTest, IsAtEaseWithTheTruth) {
  ExtrinsicMonitorNode node = MakeNode(0.0);
  for (int i = 0; i < kNumScenes; ++i) Send(i, (1 + i) * kSecondUs);
  EXPECT_TRUE(node.Step());
  test::HandleAll(&bus_);
  ASSERT_THAT(checks_.messages, SizeIs(1));
  EXPECT_NE(checks_.messages[0].check.verdict, "disagrees");
  EXPECT_EQ(node.State(), "running");
}

TEST_F(ExtrinsicMonitorNodeTest, PairsByTimeOnceASecondAndCountsWhatIsNoScene) {
  ExtrinsicMonitorNode node = MakeNode(0.0);
  Send(0, kSecondUs);
  Send(1, kSecondUs + kSecondUs / 2);  // too soon after the first
  bus_.Publish(rig_.channels.lidar_points, ToMessage((*sweeps_)[0], 10 * kSecondUs, 2));  // alone
  bus_.Publish(rig_.channels.lidar_points, ToMessage((*sweeps_)[0], 20 * kSecondUs, 3));
  bus_.Publish(rig_.channels.camera_image,
               ToMessage(cv::Mat(8, 8, CV_8U, cv::Scalar(0)), 20 * kSecondUs, 2));
  test::HandleAll(&bus_);
  EXPECT_THAT(node.counters(), SizeIs(1));  // the image of another size
  EXPECT_FALSE(node.Step());                // one scene is no stretch
}

// A replay that starts again, or a clock that was set.
TEST_F(ExtrinsicMonitorNodeTest, BeginsAnewWhereTimeIsSetBack) {
  ExtrinsicMonitorNode node = MakeNode(0.0);
  for (int i = 0; i < kNumScenes - 1; ++i) Send(i, (100 + i) * kSecondUs);
  for (int i = 0; i < kNumScenes; ++i) {
    EXPECT_FALSE(node.Step());
    Send(i, (1 + i) * kSecondUs);
  }
  EXPECT_TRUE(node.Step());
  test::HandleAll(&bus_);
  ASSERT_THAT(checks_.messages, SizeIs(1));
  EXPECT_EQ(checks_.messages[0].first_utime, kSecondUs);
  EXPECT_EQ(checks_.messages[0].check.num_scenes, kNumScenes);
}

TEST_F(ExtrinsicMonitorNodeTest, SaysThatTheClocksAreApart) {
  ExtrinsicMonitorNode node = MakeNode(0.0);
  constexpr std::int64_t kHourUs = 3600 * kSecondUs;
  for (int i = 0; i < 5; ++i) {
    EXPECT_THAT(node.State(), StartsWith("waiting"));
    bus_.Publish(rig_.channels.lidar_points, ToMessage((*sweeps_)[0], (1 + i) * kSecondUs, i));
    bus_.Publish(rig_.channels.camera_image,
                 ToMessage((*images_)[0], (1 + i) * kSecondUs + kHourUs, i));
    test::HandleAll(&bus_);
  }
  EXPECT_THAT(node.State(), AllOf(StartsWith("trouble: "), HasSubstr("clocks")));
}

TEST_F(ExtrinsicMonitorNodeTest, NeedsAnExtrinsic) {
  EXPECT_THROW(ExtrinsicMonitorNode(rig_, &bus_, folder_.path() / "none.yaml"), std::runtime_error);
}

}  // namespace
}  // namespace voqcal
