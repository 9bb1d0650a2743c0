#include "dashboard/sensor_frames.hpp"

#include <algorithm>
#include <cstring>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "messaging/convert_image.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::json;

/// A frame taken apart, as the page does it.
struct Parts {
  Json header;
  std::string payload;

  std::vector<std::int16_t> Numbers() const {
    std::vector<std::int16_t> numbers(payload.size() / 2);
    std::memcpy(numbers.data(), payload.data(), 2 * numbers.size());  // tested on little-endian
    return numbers;
  }
};

Parts Split(const FramePtr& frame) {
  EXPECT_TRUE(frame->is_binary);
  std::uint32_t length = 0;
  std::memcpy(&length, frame->bytes.data(), sizeof(length));
  return {Json::parse(frame->bytes.substr(4, length)), frame->bytes.substr(4 + length)};
}

cv::Mat Picture(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar(40, 40, 40));
  cv::rectangle(picture, {0, 0}, {width / 2, height}, {200, 200, 200}, cv::FILLED);
  return picture;
}

image_t Jpeg(int width, int height) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", Picture(width, height), bytes);
  return EncodedToMessage(bytes, 17, 0);
}

TEST(ImageFrame, PassesASmallJpegOnAsItIs) {
  const image_t image = Jpeg(640, 400);
  const Parts parts = Split(ImageFrame(ForPage(image, {}), ""));
  EXPECT_EQ(parts.payload, std::string(image.data.begin(), image.data.end()));
  EXPECT_EQ(parts.header["kind"], "image");
  EXPECT_EQ(parts.header["utime"], 17);
  EXPECT_EQ(parts.header["type"], "image/jpeg");
}

TEST(ImageFrame, HalvesUntilItFits) {
  DashboardOptions options;
  options.max_image_width_px = 700;
  const std::pair<image_t, cv::Size> cases[] = {{Jpeg(1280, 800), {640, 400}},
                                                {Jpeg(1920, 1208), {480, 302}},
                                                {ToMessage(Picture(1280, 800), 17, 0), {640, 400}},
                                                {ToMessage(Picture(640, 400), 17, 0), {640, 400}}};
  for (const auto& [image, size] : cases) {
    const Parts parts = Split(ImageFrame(ForPage(image, options), ""));
    EXPECT_EQ(parts.header["width"], image.width);  // overlays are in the original's pixels
    EXPECT_EQ(parts.header["height"], image.height);
    const cv::Mat shown = cv::imdecode(
        {parts.payload.data(), static_cast<int>(parts.payload.size())}, cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(shown.size(), size);
    // JPEG at quality 75 moves a plain area by a grey level or two.
    EXPECT_NEAR(shown.at<std::uint8_t>(size.height / 2, size.width / 4), 200, 3);
    EXPECT_NEAR(shown.at<std::uint8_t>(size.height / 2, 3 * size.width / 4), 40, 3);
  }
}

TEST(ImageFrame, RefusesWhatCannotBeDecoded) {
  DashboardOptions options;
  options.max_image_width_px = 100;
  image_t image = Jpeg(1280, 800);
  std::fill(image.data.begin(), image.data.end(), std::uint8_t{0});
  EXPECT_THROW(ForPage(image, options), std::runtime_error);
  image = Jpeg(640, 400);
  image.pixelformat = 7;
  EXPECT_THROW(ForPage(image, options), std::runtime_error);
}

TEST(ImageFrame, RefusesAJpegWithoutBytes) {
  image_t image{};
  image.pixelformat = kPixelMjpeg;
  for (const int width_px : {640, 1920}) {
    image.width = width_px;
    image.height = 400;
    EXPECT_THROW(ForPage(image, {}), std::runtime_error) << width_px;
  }
}

/// The same JPEG with another size in its header (the segment SOF0: its length, 8 bits a sample,
/// height, width), and in the message.
image_t WithSize(image_t jpeg, std::uint16_t height, std::uint16_t width) {
  const std::uint8_t kSof0[] = {0xff, 0xc0};
  auto size = std::search(jpeg.data.begin(), jpeg.data.end(), kSof0, kSof0 + 2) + 5;
  for (const std::uint16_t each : {height, width}) {
    *size++ = static_cast<std::uint8_t>(each >> 8U);
    *size++ = static_cast<std::uint8_t>(each & 0xffU);
  }
  jpeg.width = width;
  jpeg.height = height;
  return jpeg;
}

// OpenCV throws above 2^30 pixels, and takes gigabytes for a little less.
TEST(ImageFrame, RefusesASizeThatNoCameraHas) {
  EXPECT_NO_THROW(ForPage(WithSize(Jpeg(1280, 800), 800, 1280), {}));
  EXPECT_THROW(ForPage(WithSize(Jpeg(1280, 800), 40000, 40000), {}), std::runtime_error);
  EXPECT_THROW(ForPage(WithSize(Jpeg(1280, 800), 32000, 32000), {}), std::runtime_error);
}

TEST(ImageFrame, RefusesAJpegOfAnotherSizeThanTheMessages) {
  for (const int width_px : {640, 1920}) {
    image_t image = Jpeg(width_px, 400);
    image.height = 401;
    EXPECT_THROW(ForPage(image, {}), std::runtime_error) << width_px;
  }
}

TEST(ImageFrame, ShowsASingleRow) {
  const Parts parts = Split(ImageFrame(ForPage(ToMessage(Picture(1920, 1), 17, 0), {}), ""));
  const cv::Mat shown = cv::imdecode({parts.payload.data(), static_cast<int>(parts.payload.size())},
                                     cv::IMREAD_GRAYSCALE);
  EXPECT_EQ(shown.size(), cv::Size(960, 1));
}

TEST(ImageFrame, RefusesWhatNoJpegCanHold) {
  const image_t image = ToMessage(cv::Mat(70000, 1, CV_8UC1, cv::Scalar(9)), 17, 0);
  EXPECT_THROW(ForPage(image, {}), std::runtime_error);
}

/// A spinning lidar's sweep of 16 rings, firing by firing, as its driver orders it.
PointCloud SpinningSweep(int num_firings) {
  PointCloud cloud;
  cloud.has_ring = true;
  for (int i = 0; i < num_firings; ++i) {
    for (std::uint16_t ring = 0; ring < 16; ++ring) {
      const float azimuth = 6.2831853F * static_cast<float>(i) / static_cast<float>(num_firings);
      LidarPoint point;
      point.ring = ring;
      point.position_m = {
          5 * std::cos(azimuth), 5 * std::sin(azimuth), 0.1F * static_cast<float>(ring)};
      cloud.points.push_back(point);
    }
  }
  return cloud;
}

Parts SplitCloud(const PointCloud& cloud, int max_points) {
  DashboardOptions options;
  options.max_cloud_points = max_points;
  return Split(CloudFrame(cloud, 17, std::nullopt, test::TestCamera(), options));
}

// Steps of 2, 4 or 8 would leave rings out. Points drawn at random would spread by sqrt(1000 / 4) =
// 16 over the rings; evenly spread ones stay within half of that.
TEST(CloudFrame, ThinsEveryRingAlike) {
  const PointCloud sweep = SpinningSweep(1000);
  for (const int max_points : {8000, 4000, 2000, 5333}) {
    const Parts parts = SplitCloud(sweep, max_points);
    EXPECT_NEAR(parts.header["num_points"].get<int>(), max_points, 2);
    const double scale_m = parts.header["scale_m"];
    const auto numbers = parts.Numbers();
    std::map<int, int> num_of_ring;
    for (std::size_t i = 2; i < numbers.size(); i += 3) {
      ++num_of_ring[static_cast<int>(std::lround(numbers[i] * scale_m / 0.1))];
    }
    ASSERT_EQ(num_of_ring.size(), 16U);
    for (const auto& [ring, num] : num_of_ring) EXPECT_NEAR(num, max_points / 16, 8) << ring;
  }
}

TEST(CloudFrame, KeepsEveryPointOfASmallSweepToHalfAUnit) {
  PointCloud sweep = SpinningSweep(10);
  sweep.points[3].position_m = {-120, 0.01F, 2};
  const Parts parts = SplitCloud(sweep, 12000);
  ASSERT_EQ(parts.header["num_points"], 160);
  const double scale_m = parts.header["scale_m"];
  EXPECT_NEAR(scale_m, 120.0 / 32767, 1e-6);
  const auto numbers = parts.Numbers();
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(numbers[3 * i + static_cast<std::size_t>(axis)] * scale_m,
                  static_cast<double>(sweep.points[i].position_m[axis]),
                  0.51 * scale_m);
    }
  }
}

TEST(CloudFrame, LeavesOutWhatIsNoReturn) {
  PointCloud sweep = SpinningSweep(1);
  sweep.points[0].position_m.setZero();
  sweep.points[1].position_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(SplitCloud(sweep, 12000).header["num_points"], 14);
  EXPECT_EQ(SplitCloud(PointCloud(), 12000).header["num_points"], 0);
}

TEST(CloudFrame, ProjectsByTheCameraModel) {
  const CameraModel camera = test::TestCamera();
  const Eigen::Isometry3d T_camera_lidar = test::TestExtrinsic();
  const Eigen::Vector3d ahead_camera_m(0.4, -0.2, 4.0);
  PointCloud sweep;
  sweep.points.resize(2);
  sweep.points[0].position_m = (T_camera_lidar.inverse() * ahead_camera_m).cast<float>();
  sweep.points[1].position_m = (T_camera_lidar.inverse() * Eigen::Vector3d(0, 0, -4)).cast<float>();
  const Parts parts = Split(CloudFrame(sweep, 17, T_camera_lidar, camera, {}));
  EXPECT_EQ(parts.header["has_pixels"], true);
  const auto numbers = parts.Numbers();
  ASSERT_EQ(numbers.size(), 2U * 5U);
  const Eigen::Vector2d pixel = camera.Project(ahead_camera_m);
  EXPECT_NEAR(numbers[6], pixel.x(), 0.51);  // rounded to whole pixels
  EXPECT_NEAR(numbers[7], pixel.y(), 0.51);
  EXPECT_EQ(numbers[8], -32768);  // behind the camera
  EXPECT_EQ(numbers[9], -32768);
}

TEST(CloudFrame, HasNoPixelOfAPointThatIsBehindOthers) {
  const CameraModel camera = test::TestCamera();
  const Eigen::Isometry3d T_camera_lidar = test::TestExtrinsic();
  PointCloud sweep;
  for (const double x_m : {-0.05, 0.0, 0.05}) {
    const Eigen::Vector3d point_camera_m =
        x_m == 0 ? Eigen::Vector3d(0, 0, 6) : Eigen::Vector3d(x_m, 0, 2);
    sweep.points.emplace_back().position_m =
        (T_camera_lidar.inverse() * point_camera_m).cast<float>();
  }
  const auto numbers = Split(CloudFrame(sweep, 17, T_camera_lidar, camera, {})).Numbers();
  ASSERT_EQ(numbers.size(), 3U * 5U);
  EXPECT_NE(numbers[9], -32768);
  EXPECT_EQ(numbers[11], -32768);
  EXPECT_NE(numbers[13], -32768);
}

}  // namespace
}  // namespace voqcal
