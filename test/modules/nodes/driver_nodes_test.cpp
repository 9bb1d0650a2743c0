#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "camera_driver/camera_driver_node.hpp"
#include "core/simulation/simulation.hpp"
#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/convert_simulation.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/sanitizers.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_cameras.hpp"
#include "voqcal/next_pose_t.hpp"
#include "voqcal/simulated_board_t.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

// So that the tests need not wait; the frames' times follow from it, not from the clock.
constexpr double kRateHz = 1000;
constexpr std::int64_t kPeriodUs = 1000;

void RunToTheEnd(Module* driver, Bus* bus) {
  while (!driver->IsDone()) {
    driver->Step();
    test::HandleAll(bus);
    if (driver->NextStep()) std::this_thread::sleep_until(*driver->NextStep());
  }
}

/// A cloud of one point at x.
std::string PcdAt(double x) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n" +
         std::to_string(x) + " 0 0\n";
}

class DriverNodesTest : public ::testing::Test {
 protected:
  DriverNodesTest() {
    rig_.lidar_driver.folder = rig_.camera_driver.folder = folder_.path();
    rig_.lidar_driver.rate_hz = rig_.camera_driver.rate_hz = kRateHz;
  }
  void WriteImage(const std::string& name, int grey) const {
    const cv::Mat image(rig_.camera.height_px, rig_.camera.width_px, CV_8UC1, cv::Scalar(grey));
    cv::imwrite((folder_.path() / name).string(), image);
  }
  void Simulate() {
    rig_.lidar_driver.source = LidarDriverOptions::Source::kSimulator;
    rig_.camera_driver.source = CameraDriverOptions::Source::kSimulator;
    rig_.lidar_driver.rate_hz = rig_.camera_driver.rate_hz = 10;
    rig_.simulation.T_camera_lidar = test::TestExtrinsic();
    rig_.simulation.num_poses = 1;
    rig_.simulation.hold_s = 0.2;
  }

  test::TemporaryFolder folder_;
  Rig rig_ = [] {
    Rig rig = test::TestRig();
    rig.camera = test::SmallCamera(LensModel::kEquidistant);
    return rig;
  }();
  Bus bus_{"memq://"};
  test::Inbox<pointcloud2_t> clouds_{&bus_, rig_.channels.lidar_points};
  test::Inbox<image_t> images_{&bus_, rig_.channels.camera_image};
  test::Inbox<simulated_board_t> boards_{&bus_, rig_.channels.simulated_board};
  test::Inbox<camera_info_t> infos_{&bus_, rig_.channels.camera_info};
};

TEST_F(DriverNodesTest, LidarFolderComesInNaturalOrderWithTimesOfTheNumbers) {
  folder_.Write("pose10_full.pcd", PcdAt(10));
  folder_.Write("pose2_full.pcd", PcdAt(2));
  folder_.Write("notes.txt", "no cloud");
  LidarDriverNode node(rig_, &bus_);
  RunToTheEnd(&node, &bus_);
  ASSERT_THAT(clouds_.messages, SizeIs(2));
  EXPECT_EQ(FromMessage(clouds_.messages[0]).points.at(0).position_m.x(), 2.0F);
  EXPECT_EQ(FromMessage(clouds_.messages[1]).points.at(0).position_m.x(), 10.0F);
  EXPECT_EQ(clouds_.messages[0].utime, kSyntheticEpochUtime + 2 * kPeriodUs);
  EXPECT_EQ(clouds_.messages[1].utime, kSyntheticEpochUtime + 10 * kPeriodUs);
  EXPECT_EQ(clouds_.messages[1].seq, clouds_.messages[0].seq + 1);
  EXPECT_EQ(node.counters(), (test::Counters{{"sweeps", 2}}));
  EXPECT_EQ(node.State(), "source ended");
}

TEST_F(DriverNodesTest, LidarFolderMayHoldPlyFiles) {
  folder_.Write("sweep_7.ply",
                "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                "property float z\nproperty float intensity\nend_header\n7 0 0 50\n8 1 0 60\n");
  folder_.Write("sweep_9.PCD", PcdAt(9));
  LidarDriverNode node(rig_, &bus_);
  RunToTheEnd(&node, &bus_);
  ASSERT_THAT(clouds_.messages, SizeIs(2));
  const PointCloud cloud = FromMessage(clouds_.messages[0]);
  ASSERT_THAT(cloud.points, SizeIs(2));
  EXPECT_EQ(cloud.points[1].position_m, Eigen::Vector3f(8, 1, 0));
  EXPECT_EQ(cloud.points[1].intensity, 60.0F);
  EXPECT_EQ(clouds_.messages[0].utime, kSyntheticEpochUtime + 7 * kPeriodUs);
  EXPECT_EQ(FromMessage(clouds_.messages[1]).points.at(0).position_m.x(), 9.0F);
}

TEST_F(DriverNodesTest, CameraFolderPassesTheFilesOnEachWithItsInfo) {
  WriteImage("pose10.png", 10);
  WriteImage("pose2.png", 2);
  CameraDriverNode node(rig_, &bus_);
  RunToTheEnd(&node, &bus_);
  ASSERT_THAT(images_.messages, SizeIs(2));
  EXPECT_EQ(images_.messages[0].pixelformat, kPixelPng);
  EXPECT_EQ(FromMessage(images_.messages[0]).at<std::uint8_t>(0, 0), 2);
  EXPECT_EQ(FromMessage(images_.messages[1]).at<std::uint8_t>(0, 0), 10);
  EXPECT_EQ(images_.messages[0].utime, kSyntheticEpochUtime + 2 * kPeriodUs);
  EXPECT_EQ(images_.messages[1].utime, kSyntheticEpochUtime + 10 * kPeriodUs);
  ASSERT_THAT(infos_.messages, SizeIs(2));
  EXPECT_EQ(infos_.messages[1].utime, images_.messages[1].utime);
  EXPECT_EQ(FromMessage(infos_.messages[1]).fx_px, rig_.camera.fx_px);
}

TEST_F(DriverNodesTest, ARepeatingFolderIsNeverDone) {
  folder_.Write("pose1.pcd", PcdAt(1));
  rig_.lidar_driver.is_repeating = true;
  LidarDriverNode node(rig_, &bus_);
  while (clouds_.messages.size() < 3) {
    node.Step();
    test::HandleAll(&bus_);
  }
  EXPECT_FALSE(node.IsDone());
  EXPECT_EQ(clouds_.messages[2].utime, clouds_.messages[1].utime + kPeriodUs);
}

TEST_F(DriverNodesTest, NameAFolderThatIsMissingOrEmpty) {
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              HasSubstr(folder_.path().string()));
  rig_.camera_driver.folder = folder_.path() / "missing";
  EXPECT_THAT(test::ErrorOf([&] { CameraDriverNode node(rig_, &bus_); }),
              HasSubstr(rig_.camera_driver.folder.string()));
  rig_.camera_driver.folder.clear();
  EXPECT_THAT(test::ErrorOf([&] { CameraDriverNode node(rig_, &bus_); }),
              HasSubstr("camera_driver.folder: must be given"));
}

TEST_F(DriverNodesTest, LeaveOutFilesThatCannotBeRead) {
  folder_.Write("pose1.pcd", PcdAt(1));
  folder_.Write("pose2.pcd", "no cloud at all");
  folder_.Write("pose3.pcd", PcdAt(3));
  folder_.Write("._pose4.pcd", "of another system");
  LidarDriverNode lidar(rig_, &bus_);
  RunToTheEnd(&lidar, &bus_);
  EXPECT_THAT(clouds_.messages, SizeIs(2));
  folder_.Write("pose1.png", "");
  WriteImage("pose2.png", 2);
  CameraDriverNode camera(rig_, &bus_);
  RunToTheEnd(&camera, &bus_);
  EXPECT_THAT(images_.messages, SizeIs(1));
}

TEST_F(DriverNodesTest, NameAFileThatCannotBeRead) {
  const auto cloud = folder_.Write("pose1.pcd", "no cloud at all");
  LidarDriverNode node(rig_, &bus_);
  EXPECT_THAT(test::ErrorOf([&] { RunToTheEnd(&node, &bus_); }), HasSubstr(cloud.string()));
}

TEST_F(DriverNodesTest, NameAnImageThatIsNone) {
  const auto image = folder_.Write("pose1.png", "no image at all");
  CameraDriverNode node(rig_, &bus_);
  EXPECT_THAT(test::ErrorOf([&] { RunToTheEnd(&node, &bus_); }), HasSubstr(image.string()));
}

// The lidar driver decides where the board is; the camera driver waits for that.
TEST_F(DriverNodesTest, BothSimulatorsFollowTheGuidanceAlike) {
  VOQCAL_LEAVE_TO_RELEASE();
  Simulate();
  rig_.simulation.follows_guidance = true;
  rig_.simulation.num_poses = 3;
  rig_.simulation.move_s = 0.2;
  LidarDriverNode lidar(rig_, &bus_);
  CameraDriverNode camera(rig_, &bus_);
  EXPECT_EQ(camera.State(), "waiting for the simulated lidar");
  camera.Step();
  EXPECT_THAT(images_.messages, SizeIs(0));

  const Simulation simulation(rig_.simulation, rig_.board, rig_.camera);
  next_pose_t asked{};
  asked.samples_revision = 1;
  asked.T_camera_board = ToMessage(rig_.simulation.T_camera_lidar * simulation.T_lidar_board(0.4));
  bus_.Publish(rig_.channels.next_pose, asked);
  asked.samples_revision = 2;
  asked.is_enough = 1;
  while (!lidar.IsDone() || !camera.IsDone()) {
    for (Module* driver : {static_cast<Module*>(&lidar), static_cast<Module*>(&camera)}) {
      if (driver->NextStep() <= std::chrono::steady_clock::now()) driver->Step();
    }
    test::HandleAll(&bus_);
    if (clouds_.messages.size() == 8) bus_.Publish(rig_.channels.next_pose, asked);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_FALSE(boards_.messages.empty());
  const simulated_board_t& board = boards_.messages.back();
  ASSERT_EQ(board.num_stops, 2);
  ASSERT_THAT(images_.messages, SizeIs(clouds_.messages.size()));
  const auto stops = StopsFromMessage(board, kSyntheticEpochUtime);
  const std::size_t last = clouds_.messages.size() - 1;
  const double time_s = 0.1 * static_cast<double>(last);
  EXPECT_EQ(images_.messages[last].utime, clouds_.messages[last].utime);
  const Eigen::Isometry3d truth = PoseAt(time_s, stops, rig_.simulation);
  EXPECT_GT((truth.translation() - simulation.T_lidar_board(0.0).translation()).norm(), 0.01);
  EXPECT_EQ(FromMessage(clouds_.messages[last]).points.size(),
            simulation.Sweep(time_s, truth).points.size());
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg",
               simulation.Image(time_s, truth),
               jpeg,
               {cv::IMWRITE_JPEG_QUALITY, rig_.camera_driver.jpeg_quality});
  EXPECT_EQ(images_.messages[last].data, jpeg);
}

TEST_F(DriverNodesTest, BothSimulatorsShowOneWorldAtSensorTimes) {
  Simulate();
  LidarDriverNode lidar(rig_, &bus_);
  CameraDriverNode camera(rig_, &bus_);
  RunToTheEnd(&lidar, &bus_);
  RunToTheEnd(&camera, &bus_);
  // One stop of 0.2 s at 10 Hz: at 0, 0.1 and 0.2 s.
  ASSERT_THAT(clouds_.messages, SizeIs(3));
  ASSERT_THAT(images_.messages, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t utime = kSyntheticEpochUtime + static_cast<std::int64_t>(i) * 100'000;
    EXPECT_EQ(clouds_.messages[i].utime, utime);
    EXPECT_EQ(images_.messages[i].utime, utime);
  }
  const Simulation simulation(rig_.simulation, rig_.board, rig_.camera);
  const PointCloud sent = FromMessage(clouds_.messages[1]);
  const PointCloud expected = simulation.Sweep(0.1);
  ASSERT_EQ(sent.points.size(), expected.points.size());
  for (std::size_t i = 0; i < sent.points.size(); ++i) {
    ASSERT_EQ(sent.points[i].position_m, expected.points[i].position_m);
    ASSERT_EQ(sent.points[i].ring, expected.points[i].ring);
  }
  const cv::Mat image = FromMessage(images_.messages[1]);
  EXPECT_EQ(image.size(), simulation.Image(0.1).size());
  EXPECT_EQ(images_.messages[1].pixelformat, kPixelMjpeg);
}

}  // namespace
}  // namespace voqcal
