// The lidar's frame may be turned anyhow, and points may come twice.

#include <algorithm>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/lidar_detection/cloud_axes.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticLidarBoardOptions;

SyntheticLidarBoardOptions Scene() {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.01;
  scene.num_rings = 32;
  scene.T_lidar_board = FacingBoard({2.3, 0.7, 0.1}, 30.0, 10.0, -15.0);
  return scene;
}

PointCloud Turned(PointCloud cloud, const Eigen::Matrix3d& R) {
  for (LidarPoint& point : cloud.points) {
    point.position_m = (R * point.position_m.cast<double>()).cast<float>();
  }
  return cloud;
}

TEST(DetectLidarBoard, IsTheSameHoweverTheFrameIsTurned) {
  const SyntheticLidarBoardOptions scene = Scene();
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  const auto straight = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_TRUE(straight) << ToString(straight.error());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 12; ++trial) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    const auto turned = DetectLidarBoard(Turned(cloud, R), scene.board, {});
    ASSERT_TRUE(turned) << trial << ' ' << ToString(turned.error());
    // Rounding moves single points from one cell to the next: a tenth of the outline's millimetres.
    const Eigen::Vector3d expected_m = R * straight->front().pose.centre_m;
    EXPECT_LT((turned->front().pose.centre_m - expected_m).norm(), 5e-4) << trial;
    EXPECT_LT((turned->front().pose.normal - R * straight->front().pose.normal).norm(), 1e-3);
  }
}

TEST(CloudAxes, TurnWithTheCloud) {
  const PointCloud cloud = SynthesizeLidarBoard(Scene());
  const Eigen::Matrix3d R(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()));
  std::vector<Eigen::Vector3d> points_m;
  std::vector<Eigen::Vector3d> turned_m;
  for (const LidarPoint& point : cloud.points) {
    points_m.push_back(point.position_m.cast<double>());
    turned_m.push_back(R * points_m.back());
  }
  const Eigen::Matrix3d axes = CloudAxes(points_m);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-9);
  EXPECT_LT((CloudAxes(turned_m) - axes * R.transpose()).norm(), 1e-6);
}

}  // namespace
}  // namespace voqcal
