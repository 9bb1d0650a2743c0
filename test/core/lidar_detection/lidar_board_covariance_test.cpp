#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

/// A number in [low, high), the same with every library.
double Uniform(std::mt19937* random, double low, double high) {
  return low + (high - low) * static_cast<double>((*random)()) / 4294967296.0;
}

/// Mean of error^T * covariance^-1 * error over its dimension: 1 for an honest covariance.
struct NormalisedError {
  double centre = 0.0;
  double normal = 0.0;
  int num = 0;
};

PointCloud WithLineOffsets(PointCloud cloud, double sigma_m, std::mt19937* random) {
  std::map<std::uint16_t, float> offset_m;
  for (LidarPoint& point : cloud.points) {
    const auto [line, is_new] = offset_m.try_emplace(point.ring);
    if (is_new) line->second = static_cast<float>(sigma_m * test::UnitGaussian(random));
    point.position_m += line->second * point.position_m.normalized();
  }
  return cloud;
}

NormalisedError OverRandomBoards(double noise_m, double line_sigma_m, int num_boards) {
  NormalisedError mean;
  std::mt19937 random(11);
  for (int i = 0; i < num_boards; ++i) {
    test::SyntheticLidarBoardOptions scene;
    scene.noise_m = noise_m;
    scene.seed = static_cast<std::uint32_t>(i + 1);
    // As little known as the detector takes them to be.
    scene.spill_m = std::max(0.005 + 0.004 * test::UnitGaussian(&random), 0.0);
    scene.thickness_m = std::max(0.01 + 0.01 * test::UnitGaussian(&random), 0.001);
    scene.edge_blur_m = 0.003;  // beams turn from hit to miss within 3 to 4 mm
    const double x_m = Uniform(&random, 1.7, 3.2);
    const double y_m = Uniform(&random, -0.4, 0.4) * x_m;
    const double z_m = Uniform(&random, -0.15, 0.1);
    const double roll_deg = Uniform(&random, -90, 90);
    const double tilt_y_deg = Uniform(&random, -35, 35);
    const double tilt_x_deg = Uniform(&random, -35, 35);
    scene.T_lidar_board = test::FacingBoard({x_m, y_m, z_m}, roll_deg, tilt_y_deg, tilt_x_deg);
    const PointCloud cloud =
        WithLineOffsets(test::SynthesizeLidarBoard(scene), line_sigma_m, &random);
    const auto found = DetectLidarBoard(cloud, scene.board, {});
    if (!found) continue;
    const BoardPose& pose = found->front().pose;
    const Eigen::Vector3d centre_error_m = pose.centre_m - scene.T_lidar_board.translation();
    const Eigen::Matrix3d centre_covariance = pose.covariance.bottomRightCorner<3, 3>();
    mean.centre += centre_error_m.dot(centre_covariance.ldlt().solve(centre_error_m)) / 3;
    // The normal turns by e across itself: tilts about two directions in the plane.
    Eigen::Matrix<double, 3, 2> across;
    across.col(0) = pose.normal.unitOrthogonal();
    across.col(1) = pose.normal.cross(across.col(0));
    const Eigen::Vector3d turn_rad = pose.normal.cross(scene.T_lidar_board.linear().col(2));
    const Eigen::Vector2d tilt_rad = across.transpose() * turn_rad;
    const Eigen::Matrix2d tilt_covariance =
        across.transpose() * pose.covariance.topLeftCorner<3, 3>() * across;
    mean.normal += tilt_rad.dot(tilt_covariance.ldlt().solve(tilt_rad)) / 2;
    ++mean.num;
  }
  mean.centre /= mean.num;
  mean.normal /= mean.num;
  return mean;
}

struct Lidar {
  double noise_m;
  double line_sigma_m;
  double least_normal = 0.5;  // of OverRandomBoards
};

std::ostream& operator<<(std::ostream& out, const Lidar& lidar) {
  return out << lidar.noise_m << " m of noise, lines apart by " << lidar.line_sigma_m << " m";
}

class LidarBoardCovariance : public testing::TestWithParam<Lidar> {};

TEST_P(LidarBoardCovariance, MatchesTheErrorsOfRandomBoards) {
  VOQCAL_LEAVE_TO_RELEASE();
  constexpr int kNumBoards = 100;
  const NormalisedError error =
      OverRandomBoards(GetParam().noise_m, GetParam().line_sigma_m, kNumBoards);
  RecordProperty("centre", std::to_string(error.centre));
  RecordProperty("normal", std::to_string(error.normal));
  EXPECT_GE(error.num, kNumBoards * 98 / 100);
  // Means of 100 chi-squared with 3 and 2 degrees over these: 1 +- 0.08 and 1 +- 0.1 (1 sigma). The
  // covariance itself is estimated, from about ten scan lines and, as if of four more, from what is
  // expected of a lidar: within 0.5 to 2.
  EXPECT_GT(error.centre, 0.5);
  EXPECT_LT(error.centre, 2.0);
  EXPECT_GT(error.normal, GetParam().least_normal);
  EXPECT_LT(error.normal, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Lidars,
                         LidarBoardCovariance,
                         testing::Values(Lidar{0.005, 0.008},
                                         Lidar{0.01, 0.008},
                                         Lidar{0.015, 0.008},
                                         // Ten lines do not prove that lines never differ.
                                         Lidar{0.01, 0.0, 0.15},
                                         Lidar{0.01, 0.015}));

}  // namespace
}  // namespace voqcal
