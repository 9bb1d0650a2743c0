#include "core/scene/points_in_sight.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const cv::Vec3b kRed(0, 0, 200);   // of what is near
const cv::Vec3b kBlue(200, 0, 0);  // of what is behind it
constexpr double kStep = 0.0035;

/// A square of a metre before a wall.
struct TestScene {
  double square_m = 2.0;
  double wall_m = 6.0;
  double line_step = 0.0349;  ///< Scan lines 2 degrees apart.
};

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

bool IsOnWall(const Eigen::Vector3d& point_lidar_m, const TestScene& scene) {
  return point_lidar_m.x() > 0.5 * (scene.square_m + scene.wall_m);
}

/// A ray each 0.2 degrees along scan lines; `distance_m` of a ray is how long it is, in lengths of
/// the ray.
template <typename Distance>
PointCloud Sweep(double line_step, const Distance& distance_m) {
  const int num_lines_up = static_cast<int>(0.42 / line_step);
  PointCloud cloud;
  for (int line = -num_lines_up; line <= num_lines_up; ++line) {
    for (int column = -150; column <= 150; ++column) {
      const Eigen::Vector3d ray_lidar(1, kStep * column, line_step * line);
      const Eigen::Vector3d point_m = distance_m(ray_lidar) * ray_lidar;
      cloud.points.emplace_back().position_m = point_m.cast<float>();
    }
  }
  return cloud;
}

PointCloud SquareBeforeAWall(const TestScene& scene) {
  return Sweep(scene.line_step, [&](const Eigen::Vector3d& ray_lidar) {
    const bool is_on_square = IsOnSquare(BelowTheCamera() * (scene.square_m * ray_lidar));
    return is_on_square ? scene.square_m : scene.wall_m;
  });
}

/// As the camera sees them, at half its size.
cv::Mat ImageOfSquareBeforeAWall(const TestScene& scene, const CameraModel& camera) {
  cv::Mat image(camera.height_px / 2, camera.width_px / 2, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto ray = camera.Unproject(Eigen::Vector2d(2 * x + 0.5, 2 * y + 0.5));
      const bool is_near = ray && IsOnSquare(*ray * (scene.square_m / ray->z()));
      image.at<cv::Vec3b>(y, x) = is_near ? kRed : kBlue;
    }
  }
  return image;
}

struct Counts {
  int num_behind = 0;  ///< Of the points in the image, those that the square hides.
  int num_behind_in_sight = 0;
  int num_beside = 0;
  int num_beside_hidden = 0;
};

Counts CountsOf(const TestScene& scene) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const PointCloud cloud = SquareBeforeAWall(scene);
  const auto pixels_px = PixelsInSight(cloud, camera, BelowTheCamera());
  Counts counts;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const Eigen::Vector3d point_m = cloud.points[i].position_m.cast<double>();
    const Eigen::Vector3d point_camera_m = BelowTheCamera() * point_m;
    if (!camera.Contains(camera.Project(point_camera_m))) continue;
    const bool is_behind = IsOnWall(point_m, scene) &&
                           IsOnSquare(point_camera_m * (scene.square_m / point_camera_m.z()));
    ++(is_behind ? counts.num_behind : counts.num_beside);
    if (is_behind && pixels_px[i]) ++counts.num_behind_in_sight;
    if (!is_behind && !pixels_px[i]) ++counts.num_beside_hidden;
  }
  return counts;
}

class OfEachLens : public ::testing::TestWithParam<LensModel> {};

// At the square's rim one pixel of the small image may be of either: 2 px of 420 at 2 m, 1 cm.
TEST_P(OfEachLens, PaintsASquareAndTheWallBehindItEachInItsColour) {
  const CameraModel camera = test::SmallCamera(GetParam());
  const TestScene scene;
  const auto points = PointsInColour(
      SquareBeforeAWall(scene), ImageOfSquareBeforeAWall(scene, camera), camera, BelowTheCamera());
  int num_near = 0;
  int num_far = 0;
  int num_wrong = 0;
  for (const ColouredPoint& point : points) {
    const bool is_far = IsOnWall(point.position_lidar_m, scene);
    ++(is_far ? num_far : num_near);
    if (point.colour_bgr != (is_far ? kBlue : kRed)) ++num_wrong;
  }
  EXPECT_GT(num_near, 1500);
  EXPECT_GT(num_far, 1500);
  EXPECT_LT(num_wrong, 0.02 * static_cast<double>(points.size()));
}
INSTANTIATE_TEST_SUITE_P(Points, OfEachLens, ::testing::ValuesIn(test::kLenses));

TEST(PixelsInSight, AreThoseOfWhatIsBesideTheSquareNotBehindIt) {
  const Counts counts = CountsOf({});
  EXPECT_GT(counts.num_behind, 200);
  // Below the square's lowest scan line nothing tells how far down it reaches: one of the four
  // lines that it hides, at most.
  EXPECT_LT(counts.num_behind_in_sight, 0.25 * counts.num_behind);
  // Along its three other sides, 0.5 rad each, half a cell of 0.01 rad on average; of the image's
  // 1.5 x 0.94 rad: 0.0075 / 1.4.
  EXPECT_LT(counts.num_beside_hidden, 0.006 * counts.num_beside);
}

// The lidar sees 2 cm of the wall that the square hides from the camera.
TEST(PixelsInSight, AreNotThoseOfAWallCloseBehindTheSquare) {
  const Counts counts = CountsOf({4.0, 4.3, kStep});
  EXPECT_GT(counts.num_behind, 60);
  // At each end a cell of 0.01 rad at most, of 0.25 rad.
  EXPECT_LE(counts.num_behind_in_sight, 0.08 * counts.num_behind);
  EXPECT_LT(counts.num_beside_hidden, 0.006 * counts.num_beside);
}

// Both walls of a corner come nearer, to its left and to its right.
TEST(PixelsInSight, AreAllOfARightAngledCorner) {
  const PointCloud cloud = Sweep(
      kStep, [](const Eigen::Vector3d& ray_lidar) { return 5 / (1 + std::abs(ray_lidar.y())); });
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const auto pixels_px = PixelsInSight(cloud, camera, BelowTheCamera());
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const Eigen::Vector3d point_m = cloud.points[i].position_m.cast<double>();
    const bool is_in_image = camera.Contains(camera.Project(BelowTheCamera() * point_m));
    EXPECT_EQ(pixels_px[i].has_value(), is_in_image) << point_m.transpose();
  }
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
