#include "messaging/scene_window.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kMsUs = 1000;

/// Its images make no scene, each for a reason of its own: that tells which one was taken.
class SceneWindowTest : public ::testing::Test {
 protected:
  void AddSweep(std::int64_t utime) {
    PointCloud cloud;
    cloud.points.emplace_back();
    window_.Add(ToMessage(cloud, utime, 0));
  }
  void AddImage(std::int64_t utime) {
    window_.Add(ToMessage(cv::Mat(4, 4, CV_8UC1, cv::Scalar(0)), utime, 0));
  }
  void AddBrokenImage(std::int64_t utime) {
    image_t image = ToMessage(cv::Mat(4, 4, CV_8UC1, cv::Scalar(0)), utime, 0);
    image.pixelformat = 7;
    window_.Add(image);
  }

  std::vector<std::string> reasons_;
  SceneWindow window_{
      CameraModel{}, {}, {}, [this](const std::string& reason) { reasons_.push_back(reason); }};
};

TEST_F(SceneWindowTest, TakesTheNearestImage) {
  AddBrokenImage(960 * kMsUs);
  AddSweep(1000 * kMsUs);
  EXPECT_THAT(reasons_, IsEmpty());  // a nearer one may be under way
  AddImage(1010 * kMsUs);
  AddBrokenImage(1050 * kMsUs);
  EXPECT_THAT(reasons_, ElementsAre(HasSubstr("px, the camera's are")));
}

TEST_F(SceneWindowTest, HasTheImageOfASweepThatComesLateFromAFastCamera) {
  for (int i = 0; i < 40; ++i) AddBrokenImage((1000 + 8 * i) * kMsUs);
  AddSweep(1100 * kMsUs);
  EXPECT_EQ(reasons_.size(), 1U);
}

TEST_F(SceneWindowTest, DoesNotWaitForASlowCamera) {
  AddImage(1000 * kMsUs);
  for (int i = 0; i < 4; ++i) AddSweep((1020 + 100 * i) * kMsUs);
  EXPECT_EQ(reasons_.size(), 1U);
}

// A bag thinned to a pair each two seconds, the image a little before its sweep.
TEST_F(SceneWindowTest, HasEveryPairOfASlowRecording) {
  for (int i = 0; i < 4; ++i) {
    AddImage((2000 * i + 990) * kMsUs);
    AddSweep((2000 * i + 1000) * kMsUs);
  }
  EXPECT_EQ(reasons_.size(), 3U);
  window_.Finish();
  EXPECT_EQ(reasons_.size(), 4U);
}

TEST_F(SceneWindowTest, SaysThatTheClocksPartedMeanwhile) {
  const auto add = [this](int i, std::int64_t image_late_us) {
    AddSweep(100 * kMsUs * i);
    AddImage(100 * kMsUs * i + image_late_us);
  };
  for (int i = 0; i < 20; ++i) {
    add(i, 10 * kMsUs);
    EXPECT_FALSE(window_.IsWithoutPairs());
  }
  for (int i = 20; i < 30; ++i) add(i, 3600 * 1000 * kMsUs);
  EXPECT_TRUE(window_.IsWithoutPairs());
}

TEST(SceneWindow, NamesABadOption) {
  SceneWindowOptions options;
  options.every_s = 0;
  EXPECT_THROW(SceneWindow(CameraModel{}, {}, options, {}), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
