// The camera driver with `source: genicam`, on the cameras that Aravis itself has for tests: one
// within the process, and one that speaks GigE Vision on the loopback network.

#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

#include <arv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "camera_driver/camera_driver_node.hpp"
#include "messaging/convert_image.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Clock = std::chrono::steady_clock;

std::int64_t NowUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct Unref {
  void operator()(ArvGvFakeCamera* camera) const { g_object_unref(camera); }
};
using GigECamera = std::unique_ptr<ArvGvFakeCamera, Unref>;

GigECamera MakeGigECamera() { return GigECamera(arv_gv_fake_camera_new("127.0.0.1", "GV01")); }

class GenicamCamera : public ::testing::Test {
 protected:
  GenicamCamera() {
    rig_.camera_driver.source = CameraDriverOptions::Source::kGenicam;
    rig_.camera_driver.rate_hz = 25;
    rig_.camera_driver.retry_s = 0.01;
    arv_enable_interface("Fake");
  }
  ~GenicamCamera() override { arv_disable_interface("Fake"); }

  /// Until so many images are there, or ten seconds are over.
  void RunUntil(CameraDriverNode* driver, std::size_t num_images) {
    const auto end = Clock::now() + std::chrono::seconds(10);
    while (images_.messages.size() < num_images && Clock::now() < end) {
      driver->Step();
      test::HandleAll(&bus_);
      std::this_thread::sleep_until(*driver->NextStep());
    }
  }

  Rig rig_ = test::TestRig();
  Bus bus_{"memq://"};
  test::Inbox<image_t> images_{&bus_, rig_.channels.camera_image};
};

TEST_F(GenicamCamera, GivesImagesOfTheMiddleOfTheirExposure) {
  rig_.camera_driver.camera_id = "Fake_1";
  CameraDriverNode node(rig_, &bus_);
  const std::int64_t begin = NowUtime();
  RunUntil(&node, 4);
  ASSERT_EQ(images_.messages.size(), 4U);
  EXPECT_EQ(node.State(), "running");
  const cv::Mat image = FromMessage(images_.messages.back());
  EXPECT_EQ(image.size(), cv::Size(512, 512));  // as Aravis has it
  EXPECT_EQ(image.channels(), 1);
  // The camera stamps by the host's clock, and exposes for 10 ms.
  constexpr std::int64_t kHalfExposureUs = 5000;
  for (const image_t& message : images_.messages) {
    EXPECT_GT(message.utime, begin);
    EXPECT_LT(message.utime, NowUtime() + kHalfExposureUs);
  }
  const std::int64_t apart_us = images_.messages[3].utime - images_.messages[2].utime;
  EXPECT_NEAR(static_cast<double>(apart_us), 40'000, 20'000);
}

TEST_F(GenicamCamera, ThatIsNotThereIsWaitedForWithThoseThatAre) {
  rig_.camera_driver.camera_id = "Basler-1";
  CameraDriverNode node(rig_, &bus_);
  node.Step();
  EXPECT_THAT(node.State(),
              AllOf(StartsWith("waiting for the camera: no camera Basler-1; cameras here: "),
                    HasSubstr("Fake_1")));
  EXPECT_EQ(node.counters(), (test::Counters{{"camera lost", 1}}));
}

TEST_F(GenicamCamera, OfANetworkIsFoundAgain) {
  GigECamera camera = MakeGigECamera();
  rig_.camera_driver.camera_id = "Aravis-Fake-GV01";
  CameraDriverNode node(rig_, &bus_);
  RunUntil(&node, 2);
  ASSERT_EQ(images_.messages.size(), 2U) << node.State();
  camera.reset();
  while (node.State() == "running") node.Step();
  EXPECT_THAT(node.State(), StartsWith("waiting for Aravis-Fake-GV01, lost after "));
  const std::size_t num_before = images_.messages.size();
  camera = MakeGigECamera();
  RunUntil(&node, num_before + 2);
  EXPECT_EQ(images_.messages.size(), num_before + 2) << node.State();
  EXPECT_EQ(node.counters().at("camera lost"), 1);
  EXPECT_EQ(node.counters().at("camera found again"), 1);
}

TEST_F(GenicamCamera, MustBeNamedAmongSeveral) {
  const GigECamera camera = MakeGigECamera();
  CameraDriverNode node(rig_, &bus_);
  node.Step();
  EXPECT_THAT(node.State(),
              AllOf(HasSubstr("camera_driver.camera_id must name one of the cameras here: "),
                    HasSubstr("Aravis-Fake-GV01 (127.0.0.1)"),
                    HasSubstr("Fake_1")));
}

}  // namespace
}  // namespace voqcal
