#include "core/guidance/expected_sample.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/camera_detection/planar_pose.hpp"
#include "core/geometry/rigid.hpp"
#include "core/guidance/placement.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "core/units.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;

Eigen::Isometry3d Held(double distance_m, double yaw_deg, double pitch_deg) {
  const Placement placement{{1100, 560}, distance_m, yaw_deg * kRadPerDeg, pitch_deg * kRadPerDeg};
  return *PoseOf(placement, test::TestCamera(), test::TestExtrinsic().linear().col(2));
}

BoardSample Expected(const Eigen::Isometry3d& T_camera_board) {
  return ExpectedSample(
      T_camera_board, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {});
}

LidarSimulator Vlp16InAHall(double range_noise_m) {
  SimulationOptions options;
  options.range_noise_m = range_noise_m;
  options.ring_bias_m = 0.0;
  options.dark_bias_m = 0.0;
  const Box hall{{-9.0, -9.0, -1.5}, {9.0, 9.0, 3.0}, Material::kWall};
  return LidarSimulator(options, test::TestBoard(), Room(hall, Props{}));
}

TEST(ExpectedSample, HasTheReturnsAndRowsOfASweep) {
  const LidarSimulator lidar = Vlp16InAHall(0.0);
  for (const double distance_m : {1.5, 2.5, 4.0}) {
    const Eigen::Isometry3d T_camera_board = Held(distance_m, 20, -20);
    const Eigen::Isometry3d T_lidar_board = test::TestExtrinsic().inverse() * T_camera_board;
    const BoardSample expected = Expected(T_camera_board);
    const BoardHits hits = lidar.CountBoardHits(T_lidar_board, 0);
    const auto num_points = static_cast<double>(expected.lidar.points_lidar_m.points.size());
    // A row loses or gains half of a thinned step at each end, and the last rows at the corners.
    EXPECT_NEAR(kExpectedThinning * num_points, hits.num_points, 0.1 * hits.num_points);
    EXPECT_NEAR(expected.lidar.num_beams, hits.num_rings, 2);
    for (const LidarPoint& point : expected.lidar.points_lidar_m.points) {
      const Eigen::Vector3d at_board_m = T_lidar_board.inverse() * point.position_m.cast<double>();
      EXPECT_NEAR(at_board_m.z(), 0.0, 1e-6);  // single precision
      const double elevation_rad =
          std::asin(point.position_m.z() / point.position_m.cast<double>().norm());
      EXPECT_NEAR(elevation_rad, (-15.0 + 2.0 * point.ring) * kRadPerDeg, 1e-6);
    }
  }
}

// The oracle: the camera's own fit, of corners with noise.
TEST(ExpectedSample, HasTheSpreadOfTheCamerasPoses) {
  constexpr int kNumDraws = 400;
  const Eigen::Isometry3d T_camera_board = Held(2.5, 25, 25);
  const BoardSample expected = Expected(T_camera_board);
  const auto corners_board_m = test::TestBoard().InnerCornersBoardM();
  test::Random random(3);
  Matrix6d spread = Matrix6d::Zero();
  for (int i = 0; i < kNumDraws; ++i) {
    std::vector<Eigen::Vector2d> corners_px = expected.camera.corners_px;
    for (Eigen::Vector2d& corner_px : corners_px) {
      corner_px += SensorExpectation{}.corner_noise_px * random.NormalVector().head<2>();
    }
    const auto fit = FitPlanarPose(test::TestCamera(), corners_board_m, corners_px);
    ASSERT_TRUE(fit);
    const Vector6d error = DifferenceLeft(T_camera_board, fit->T_camera_board);
    spread += error * error.transpose() / kNumDraws;
  }
  const Vector6d ratio =
      expected.camera.pose.covariance.diagonal().cwiseQuotient(spread.diagonal());
  // A variance of 400 draws is known to sqrt(2 / 400) = 7 %; allow 4 sigma.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(ratio[i], 1.0, 0.28) << i;
}

// The detector's own covariance is of the beams of this very sweep, hits and misses; the expected
// one of rows on average: half to twice. In the board's plane: two sides, and the turn.
TEST(ExpectedSample, KnowsTheOutlineAboutAsWellAsTheDetector) {
  const LidarSimulator lidar = Vlp16InAHall(0.005);
  for (const double distance_m : {1.5, 2.5, 4.0}) {
    const Eigen::Isometry3d T_camera_board = Held(distance_m, 20, 0);
    const Eigen::Isometry3d T_lidar_board = test::TestExtrinsic().inverse() * T_camera_board;
    const auto found = DetectLidarBoard(lidar.Sweep(T_lidar_board, 0), test::TestBoard(), {});
    ASSERT_TRUE(found);
    const auto in_plane = [&](const Matrix6d& covariance) {
      const Eigen::Matrix3d R = T_lidar_board.linear();
      const Eigen::Matrix3d rotation = R.transpose() * covariance.topLeftCorner<3, 3>() * R;
      const Eigen::Matrix3d centre = R.transpose() * covariance.bottomRightCorner<3, 3>() * R;
      return Eigen::Vector3d(centre(0, 0), centre(1, 1), rotation(2, 2)).cwiseSqrt().eval();
    };
    const Eigen::Vector3d ratio = in_plane(Expected(T_camera_board).lidar.pose.covariance)
                                      .cwiseQuotient(in_plane(found->front().pose.covariance));
    EXPECT_GT(ratio.minCoeff(), 0.5) << distance_m << ": " << ratio.transpose();
    EXPECT_LT(ratio.maxCoeff(), 2.0) << distance_m << ": " << ratio.transpose();
  }
}

TEST(SensorExpectation, NamesEachProblem) {
  EXPECT_THAT(SensorExpectation{}.Problems(), ElementsAre());
  SensorExpectation bad;
  bad.min_elevation_rad = 10 * kRadPerDeg;
  bad.max_elevation_rad = 5 * kRadPerDeg;
  bad.max_azimuth_rad = 0.0;
  bad.num_rows = 1;
  bad.column_step_rad = 0.0;
  bad.corner_noise_px = 0.0;
  EXPECT_THAT(bad.Problems(),
              ElementsAre("max_elevation_deg must exceed min_elevation_deg, is 5",
                          "max_azimuth_deg must be within 0 and 180, is 0",
                          "num_rows must be at least 2, is 1",
                          "column_step_deg must be within 0 and 5, is 0",
                          "corner_noise_px must be positive, is 0"));
  bad = {};
  bad.num_rows = 256;
  EXPECT_THAT(bad.Problems(), ElementsAre());
  bad.num_rows = 257;
  EXPECT_THAT(bad.Problems(), ElementsAre("num_rows must be at most 256, is 257"));
}

}  // namespace
}  // namespace voqcal
