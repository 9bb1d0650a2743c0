#include "core/simulation/board_prop.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/simulation/keyed_noise.hpp"
#include "simulated_rig.hpp"

namespace voqcal {
namespace {

TEST(BoardFace, SquaresAlternateAroundEveryInnerCorner) {
  const BoardSpec board = test::CleanRig().board;
  const BoardFace face(board);
  for (const Eigen::Vector3d& corner : board.InnerCornersBoardM()) {
    const double step = board.square_m / 3;
    const auto is_dark = [&](double dx, double dy) {
      return face.IsDark(face.CellAt(corner.x() + dx, corner.y() + dy));
    };
    EXPECT_EQ(is_dark(step, step), is_dark(-step, -step));
    EXPECT_EQ(is_dark(step, -step), is_dark(-step, step));
    EXPECT_NE(is_dark(step, step), is_dark(step, -step));
  }
}

TEST(BoardFace, PatternEndsOneSquareBeyondTheInnerCorners) {
  const BoardSpec board = test::CleanRig().board;
  const BoardFace face(board);
  const Eigen::Vector3d first = board.InnerCornersBoardM().front();
  const double half = board.square_m / 2;
  EXPECT_TRUE(face.IsDark(face.CellAt(first.x() - half, first.y() - half)));
  EXPECT_FALSE(face.IsDark(face.CellAt(first.x() - 2 * half - 0.001, first.y() - half)));
  EXPECT_FALSE(face.IsOutside(face.CellAt(first.x() - 2 * half - 0.001, first.y() - half)));
}

TEST(BoardFace, EndsAtTheOutline) {
  const BoardSpec board = test::CleanRig().board;
  const BoardFace face(board);
  const double x = board.width_m / 2;
  const double y = board.height_m / 2;
  for (const double side : {-1.0, 1.0}) {
    EXPECT_FALSE(face.IsOutside(face.CellAt(side * (x - 1e-6), 0.0)));
    EXPECT_TRUE(face.IsOutside(face.CellAt(side * (x + 1e-6), 0.0)));
    EXPECT_FALSE(face.IsOutside(face.CellAt(0.0, side * (y - 1e-6))));
    EXPECT_TRUE(face.IsOutside(face.CellAt(0.0, side * (y + 1e-6))));
  }
}

TEST(TubeCast, HitsTheNearSideOfTheTube) {
  const Tube tube{{3.0, 0.1, -1.0}, {3.5, -0.2, 1.0}, 0.05};
  const Eigen::Vector3d origin_m(0.2, 0.0, 0.1);
  const Eigen::Vector3d axis = (tube.end_m - tube.begin_m).normalized();
  const Eigen::Vector3d direction = (Eigen::Vector3d(3.25, -0.02, 0.03) - origin_m).normalized();
  const auto range_m = tube.Cast(origin_m, direction);
  ASSERT_TRUE(range_m);
  const auto distance_to_axis = [&](double range) {
    return axis.cross(origin_m + range * direction - tube.begin_m).norm();
  };
  EXPECT_NEAR(distance_to_axis(*range_m), tube.radius_m, 1e-9);
  EXPECT_GT(distance_to_axis(*range_m - 1e-3), tube.radius_m);  // from outside
  EXPECT_FALSE(tube.Cast(origin_m, -direction));
  EXPECT_FALSE(tube.Cast(origin_m, Eigen::Vector3d(3.25, 0.2, 0.0).normalized()));
}

TEST(StandTubes, StayBehindTheFaceAndStandOnTheFloor) {
  constexpr double kFloorZM = -1.2;
  const BoardSpec board = test::CleanRig().board;
  const KeyedNoise noise(3, NoiseUse::kStops);
  for (int i = 0; i < 200; ++i) {
    const auto draw = [&](int k) { return 2 * noise.Uniform(8 * i + k) - 1; };
    const double max_tilt_rad = 0.7;
    Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
    Eigen::Matrix3d R_upright;  // facing the lidar from +x
    R_upright << 0, 0, -1, -1, 0, 0, 0, 1, 0;
    T_lidar_board.linear() =
        R_upright * (Eigen::AngleAxisd(max_tilt_rad * draw(0), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(max_tilt_rad * draw(1), Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(0.8 + 0.3 * draw(2), Eigen::Vector3d::UnitZ()))
                        .toRotationMatrix();
    T_lidar_board.translation() = Eigen::Vector3d(3.0, draw(3), 0.3 * draw(4));
    double lowest_m = 1.0;
    for (const auto& corner : board.OutlineBoardM()) {
      lowest_m = std::min(lowest_m, (T_lidar_board * corner).z());
    }
    double lowest_tube_m = 1.0;
    for (const Tube& tube : StandTubes(T_lidar_board, board, kFloorZM)) {
      for (int k = 0; k <= 100; ++k) {
        const Eigen::Vector3d point = tube.begin_m + k / 100.0 * (tube.end_m - tube.begin_m);
        lowest_tube_m = std::min(lowest_tube_m, point.z() - tube.radius_m);
        // Level with the board: behind its plane. Below it: cannot be in front of it.
        if (point.z() + tube.radius_m < lowest_m) continue;
        EXPECT_LT((T_lidar_board.inverse() * point).z(), -0.005) << "pose " << i;
      }
    }
    EXPECT_NEAR(lowest_tube_m, kFloorZM, 0.035);
  }
}

}  // namespace
}  // namespace voqcal
