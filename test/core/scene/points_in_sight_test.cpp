#include "core/scene/points_in_sight.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const cv::Vec3b kRed(0, 0, 200);   // of what is near
const cv::Vec3b kBlue(200, 0, 0);  // of what is behind it
constexpr double kNearM = 2.0;
constexpr double kFarM = 6.0;

/// The lidar is below the camera: it sees past a near object's lower edge what that hides.
Eigen::Isometry3d BelowTheCamera() {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_camera_lidar.translation() << 0, 0.3, 0;
  return T_camera_lidar;
}

bool IsOnSquare(const Eigen::Vector3d& point_camera_m) {
  return point_camera_m.head<2>().cwiseAbs().maxCoeff() < 0.5;
}

bool IsFar(const ColouredPoint& point) { return point.position_lidar_m.x() > 4; }

/// Scan lines 2 degrees apart, as far as a square of a metre before a wall lets them.
PointCloud SquareBeforeAWall() {
  constexpr double kLineStep = 0.0349;
  constexpr double kStep = 0.0035;
  const Eigen::Isometry3d T_camera_lidar = BelowTheCamera();
  PointCloud cloud;
  for (int line = -12; line <= 12; ++line) {
    for (int column = -150; column <= 150; ++column) {
      const Eigen::Vector3d ray_lidar(1, kStep * column, kLineStep * line);
      Eigen::Vector3d point_m = kNearM * ray_lidar;
      if (!IsOnSquare(T_camera_lidar * point_m)) point_m = kFarM * ray_lidar;
      cloud.points.emplace_back().position_m = point_m.cast<float>();
    }
  }
  return cloud;
}

/// As the camera sees them, at half its size.
cv::Mat ImageOfSquareBeforeAWall(const CameraModel& camera) {
  cv::Mat image(camera.height_px / 2, camera.width_px / 2, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto ray = camera.Unproject(Eigen::Vector2d(2 * x + 0.5, 2 * y + 0.5));
      const bool is_near = ray && IsOnSquare(*ray * (kNearM / ray->z()));
      image.at<cv::Vec3b>(y, x) = is_near ? kRed : kBlue;
    }
  }
  return image;
}

/// Whether the square hides this point of the wall.
bool IsBehindSquare(const ColouredPoint& point) {
  const Eigen::Vector3d point_camera_m = BelowTheCamera() * point.position_lidar_m;
  return IsOnSquare(point_camera_m * (kNearM / point_camera_m.z()));
}

class OfEachLens : public ::testing::TestWithParam<LensModel> {};

// At the square's rim one pixel of the small image may be of either: 2 px of 420 at 2 m, 1 cm.
TEST_P(OfEachLens, PaintsASquareAndTheWallBehindItEachInItsColour) {
  const CameraModel camera = test::SmallCamera(GetParam());
  const auto points = PointsInColour(
      SquareBeforeAWall(), ImageOfSquareBeforeAWall(camera), camera, BelowTheCamera());
  int num_near = 0;
  int num_far = 0;
  int num_wrong = 0;
  for (const ColouredPoint& point : points) {
    ++(IsFar(point) ? num_far : num_near);
    if (point.colour_bgr != (IsFar(point) ? kBlue : kRed)) ++num_wrong;
  }
  EXPECT_GT(num_near, 1500);
  EXPECT_GT(num_far, 1500);
  EXPECT_LT(num_wrong, 0.02 * static_cast<double>(points.size()));
}
INSTANTIATE_TEST_SUITE_P(Points, OfEachLens, ::testing::ValuesIn(test::kLenses));

TEST(PixelsInSight, AreThoseOfWhatIsBesideTheSquareNotBehindIt) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const PointCloud cloud = SquareBeforeAWall();
  const auto pixels_px = PixelsInSight(cloud, camera, BelowTheCamera());
  ASSERT_EQ(pixels_px.size(), cloud.points.size());
  int num_behind = 0;
  int num_behind_in_sight = 0;
  int num_beside = 0;
  int num_beside_hidden = 0;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const ColouredPoint point{cloud.points[i].position_m.cast<double>(), {}};
    const Eigen::Vector3d point_camera_m = BelowTheCamera() * point.position_lidar_m;
    const bool is_in_image = camera.Contains(camera.Project(point_camera_m));
    const bool is_behind = IsFar(point) && IsBehindSquare(point);
    num_behind += is_behind && is_in_image;
    num_behind_in_sight += is_behind && pixels_px[i];
    num_beside += !is_behind && is_in_image;
    num_beside_hidden += !is_behind && is_in_image && !pixels_px[i];
  }
  EXPECT_GT(num_behind, 200);
  // Below the square's lowest scan line nothing tells how far down it reaches: one of the four
  // lines that it hides, at most.
  EXPECT_LT(num_behind_in_sight, 0.25 * num_behind);
  // Along its three other sides, 0.5 rad each, half a cell of 0.01 rad on average; of the image's
  // 1.5 x 0.94 rad: 0.0075 / 1.4.
  EXPECT_LT(num_beside_hidden, 0.006 * num_beside);
}

TEST(PixelsInSight, AreNoneBehindTheCameraOutsideTheImageAndOfNoReturn) {
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  PointCloud cloud;
  for (const Eigen::Vector3f& position_m : {Eigen::Vector3f(4, 0, 0),
                                            Eigen::Vector3f(-4, 0, 0),
                                            Eigen::Vector3f(1, 4, 0),
                                            Eigen::Vector3f(0, 0, 0),
                                            Eigen::Vector3f(nan, nan, nan)}) {
    cloud.points.emplace_back().position_m = position_m;
  }
  const auto pixels_px = PixelsInSight(cloud, camera, BelowTheCamera());
  ASSERT_EQ(pixels_px.size(), 5U);
  ASSERT_TRUE(pixels_px[0]);
  EXPECT_TRUE(pixels_px[0]->isApprox(camera.Project(Eigen::Vector3d(0, 0.3, 4)), 1e-6));
  for (std::size_t i = 1; i < 5; ++i) EXPECT_FALSE(pixels_px[i]) << i;
}

TEST(PointsInColour, TakesTheColourAtTheProjection) {
  const CameraModel camera = test::SmallCamera(LensModel::kRational);
  cv::Mat image(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar(0, 0, 0));
  const Eigen::Vector3d point_camera_m(0.4, -0.2, 3);
  const Eigen::Vector2d pixel_px = camera.Project(point_camera_m);
  image.at<cv::Vec3b>(static_cast<int>(std::lround(pixel_px.y())),
                      static_cast<int>(std::lround(pixel_px.x()))) = kRed;
  PointCloud cloud;
  cloud.points.emplace_back().position_m =
      (BelowTheCamera().inverse() * point_camera_m).cast<float>();
  const auto points = PointsInColour(cloud, image, camera, BelowTheCamera());
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].colour_bgr, kRed);
  EXPECT_TRUE(
      points[0].position_lidar_m.isApprox(BelowTheCamera().inverse() * point_camera_m, 1e-6));
}

}  // namespace
}  // namespace voqcal
