// The camera driver with `source: video`, on video files that the tests write.

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "camera_driver/camera_driver_node.hpp"
#include "camera_driver/capture_clock.hpp"
#include "files/atomic_file.hpp"
#include "messaging/convert_image.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr int kNumFrames = 12;
constexpr double kFps = 25;

/// An MJPEG file; frame i is of grey level 20 i.
std::string VideoAt(const std::filesystem::path& path, const CameraModel& camera) {
  cv::VideoWriter writer(path.string(),
                         cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         kFps,
                         {camera.width_px, camera.height_px});
  for (int i = 0; i < kNumFrames; ++i) {
    writer.write(cv::Mat(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar::all(20.0 * i)));
  }
  writer.release();
  return ReadWholeFile(path);
}

void Overwrite(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class CameraVideoTest : public ::testing::Test {
 protected:
  CameraVideoTest() {
    rig_.camera = test::SmallCamera(LensModel::kEquidistant);
    rig_.camera_driver.source = CameraDriverOptions::Source::kVideo;
    rig_.camera_driver.url = (folder_.path() / "video.avi").string();
    rig_.camera_driver.rate_hz = 1000;
    rig_.camera_driver.retry_s = 0.001;
  }

  /// Until the driver is done, or waits for its camera.
  void RunUntilItStops(CameraDriverNode* driver) {
    do {
      driver->Step();
      test::HandleAll(&bus_);
      std::this_thread::sleep_until(*driver->NextStep());
    } while (driver->State() == "running");
  }

  test::TemporaryFolder folder_;
  Rig rig_ = test::TestRig();
  Bus bus_{"memq://"};
  test::Inbox<image_t> images_{&bus_, rig_.channels.camera_image};
};

TEST_F(CameraVideoTest, PassesAFilesJpegsOnAsTheyAre) {
  const std::string file = VideoAt(rig_.camera_driver.url, rig_.camera);
  CameraDriverNode node(rig_, &bus_);
  RunUntilItStops(&node);
  EXPECT_TRUE(node.IsDone());
  ASSERT_THAT(images_.messages, SizeIs(kNumFrames));
  for (int i = 0; i < kNumFrames; ++i) {
    const image_t& image = images_.messages[i];
    EXPECT_EQ(image.utime, kSyntheticEpochUtime + i * 40'000);
    EXPECT_EQ(image.pixelformat, kPixelMjpeg);
    EXPECT_NEAR(FromMessage(image).at<cv::Vec3b>(5, 5)[0], 20 * i, 2);  // by compression
    const std::string jpeg(image.data.begin(), image.data.end());
    EXPECT_NE(file.find(jpeg), std::string::npos) << i;
  }
  EXPECT_EQ(node.counters(), (test::Counters{{"images", kNumFrames}}));
}

TEST_F(CameraVideoTest, GoesOnWhenAFileThatWasCutOffIsWhole) {
  const std::string file = VideoAt(rig_.camera_driver.url, rig_.camera);
  Overwrite(rig_.camera_driver.url, file.substr(0, file.size() * 6 / 10));
  CameraDriverNode node(rig_, &bus_);
  RunUntilItStops(&node);
  EXPECT_FALSE(node.IsDone());
  EXPECT_THAT(node.State(), StartsWith("waiting for " + rig_.camera_driver.url));
  const std::size_t num_before = images_.messages.size();
  EXPECT_GT(num_before, 2u);
  EXPECT_LT(num_before, 10u);

  Overwrite(rig_.camera_driver.url, file);
  RunUntilItStops(&node);
  EXPECT_TRUE(node.IsDone());
  ASSERT_THAT(images_.messages, SizeIs(kNumFrames));
  for (int i = 0; i < kNumFrames; ++i) {
    EXPECT_EQ(images_.messages[i].utime, kSyntheticEpochUtime + i * 40'000);
    EXPECT_NEAR(FromMessage(images_.messages[i]).at<cv::Vec3b>(5, 5)[0], 20 * i, 2);
  }
  EXPECT_EQ(
      node.counters(),
      (test::Counters{{"images", kNumFrames}, {"camera lost", 1}, {"camera found again", 1}}));
}

TEST_F(CameraVideoTest, WaitsForACameraThatIsNotThere) {
  rig_.camera_driver.url = "";
  rig_.camera_driver.device = "/dev/no_such_camera";
  CameraDriverNode node(rig_, &bus_);
  RunUntilItStops(&node);
  node.Step();
  EXPECT_FALSE(node.IsDone());
  EXPECT_EQ(node.State(), "waiting for /dev/no_such_camera");
  EXPECT_EQ(node.counters(), (test::Counters{{"camera lost", 1}}));
}

TEST_F(CameraVideoTest, ARepeatedFileGoesOnInTime) {
  VideoAt(rig_.camera_driver.url, rig_.camera);
  rig_.camera_driver.is_repeating = true;
  CameraDriverNode node(rig_, &bus_);
  while (images_.messages.size() < 2 * kNumFrames) {
    node.Step();
    test::HandleAll(&bus_);
  }
  EXPECT_EQ(images_.messages[kNumFrames].utime, kSyntheticEpochUtime + kNumFrames * 40'000);
  EXPECT_FALSE(node.IsDone());
}

TEST(DriverOptionsVideo, NamesOneCamera) {
  CameraDriverOptions options;
  options.source = CameraDriverOptions::Source::kVideo;
  EXPECT_THAT(options.Problems().at(0), HasSubstr("one of device, pipeline and url, has 0"));
  options.device = "/dev/video0";
  EXPECT_THAT(options.Problems(), ::testing::IsEmpty());
  options.url = "rtsp://camera/stream";
  EXPECT_THAT(options.Problems().at(0), HasSubstr("has 2"));
}

/// The host's clocks: the wall clock is ahead of the steady one.
CaptureClock::Arrival At(std::int64_t steady_us, std::int64_t ahead_us) {
  return {steady_us + ahead_us, steady_us};
}

TEST(CaptureClock, TakesTheLeastDelayAndKeepsTheStreamsSteps) {
  CaptureClock clock;
  constexpr std::int64_t kAheadUs = 1'700'000'000'000'000;
  // Delays of 30, 10, 50, 20 ms after capture.
  EXPECT_EQ(clock.UtimeOf(At(30'000, kAheadUs), 0), kAheadUs + 30'000);
  EXPECT_EQ(clock.UtimeOf(At(50'000, kAheadUs), 40'000), kAheadUs + 50'000);
  // From here on by the delay of 10 ms, but for 100 us a second of elapsed time.
  EXPECT_EQ(clock.UtimeOf(At(130'000, kAheadUs), 80'000), kAheadUs + 80'000 + 10'008);
  EXPECT_EQ(clock.UtimeOf(At(140'000, kAheadUs), 120'000), kAheadUs + 120'000 + 10'009);
}

TEST(CaptureClock, FollowsAClockThatRunsSlowAtAnyRate) {
  for (const std::int64_t period_us : {1'000'000, 33'333, 4'000}) {
    CaptureClock clock;
    std::int64_t error_us = 0;
    for (std::int64_t us = 0; us < 600'000'000; us += period_us) {
      const std::int64_t stream_us = us - us / 20'000;  // 50 ppm slow
      error_us = clock.UtimeOf(At(us, 0), stream_us) - us;
    }
    EXPECT_EQ(error_us, 0) << period_us;
  }
}

TEST(CaptureClock, FollowsTheHostsClockWhenItIsSet) {
  CaptureClock clock;
  constexpr std::int64_t kHourUs = 3'600'000'000;
  const auto delay_us = [&clock](std::int64_t us, std::int64_t ahead_us) {
    return clock.UtimeOf(At(us, ahead_us), us) - us - ahead_us;
  };
  EXPECT_EQ(delay_us(100'000, 0), 0);
  EXPECT_EQ(delay_us(200'000, kHourUs), 0);   // set forward
  EXPECT_EQ(delay_us(300'000, -kHourUs), 0);  // and back
}

TEST(CaptureClock, WithoutAStreamsTimeTheFrameCameAtOnce) {
  EXPECT_EQ(CaptureClock().UtimeOf({123, 5}, std::nullopt), 123);
}

}  // namespace
}  // namespace voqcal
