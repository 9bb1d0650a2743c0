#include "core/simulation/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "core/simulation/board_script.hpp"
#include "core/simulation/clutter.hpp"
#include "simulated_rig.hpp"
#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

constexpr int kNumBeams = 16 * 1800;
// Near the outline; farther out the board's plane meets the walls.
constexpr double kAroundM = 0.05;
constexpr double kFloatM = 2e-6;  // rounding of a float at 10 m, on three axes

// The direction that the VLP-16 pattern gives a point's beam, from its ring and time alone.
Eigen::Vector3d BeamOf(const LidarPoint& point) {
  const double elevation_rad = (-15.0 + 2.0 * point.ring) * M_PI / 180.0;
  const double azimuth_rad = M_PI - 2.0 * M_PI * std::round(point.time_s / 0.1 * 1800.0) / 1800.0;
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

int BeamNumber(const LidarPoint& point) {
  return static_cast<int>(std::lround(point.time_s / 0.1 * 1800.0)) * 16 + point.ring;
}

std::map<int, double> RangesOf(const PointCloud& cloud) {
  std::map<int, double> ranges_m;
  for (const LidarPoint& point : cloud.points) {
    ranges_m[BeamNumber(point)] = point.position_m.cast<double>().norm();
  }
  return ranges_m;
}

// Where a ray from the lidar meets the board's plane: range, and place on the plane.
struct OnPlane {
  double range_m;
  double x_m;
  double y_m;
};
OnPlane MeetPlane(const Eigen::Isometry3d& T_lidar_board, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = T_lidar_board.linear().col(2);
  const double range_m = normal.dot(T_lidar_board.translation()) / normal.dot(direction);
  const Eigen::Vector3d offset_m = range_m * direction - T_lidar_board.translation();
  return {range_m,
          T_lidar_board.linear().col(0).dot(offset_m),
          T_lidar_board.linear().col(1).dot(offset_m)};
}

// How far a place is inside the outline; negative outside.
double InsideM(const OnPlane& place, const BoardSpec& board) {
  if (place.range_m <= 0) return -1e9;
  return std::min(board.width_m / 2 - std::abs(place.x_m),
                  board.height_m / 2 - std::abs(place.y_m));
}

Eigen::Isometry3d StopOf(const test::SimulatedRig& rig, int stop) {
  return BoardScript(rig.options, rig.board, rig.camera, Room())
      .T_lidar_board(test::TimeAtStopS(rig.options, stop));
}

LidarSimulator SimulatorOf(const test::SimulatedRig& rig) {
  return LidarSimulator(rig.options, rig.board, Room());
}

TEST(Sweep, FollowsThePattern) {
  const test::SimulatedRig rig = test::CleanRig();
  const PointCloud cloud = SimulatorOf(rig).Sweep(StopOf(rig, 0), 0);
  EXPECT_TRUE(cloud.has_intensity && cloud.has_ring && cloud.has_time);
  ASSERT_EQ(cloud.points.size(), static_cast<std::size_t>(kNumBeams));
  for (const LidarPoint& point : cloud.points) {
    ASSERT_LT(point.ring, 16);
    ASSERT_GE(point.time_s, 0.0F);
    ASSERT_LT(point.time_s, 0.1F);
    ASSERT_LT(point.position_m.cast<double>().cross(BeamOf(point)).norm(), kFloatM);
  }
}

TEST(Sweep, WithoutFaultsMeetsTheBoardExactly) {
  const test::SimulatedRig rig = test::CleanRig();
  const LidarSimulator lidar = SimulatorOf(rig);
  for (int stop = 0; stop < rig.options.num_poses; ++stop) {
    const Eigen::Isometry3d T_lidar_board = StopOf(rig, stop);
    int num_on_board = 0;
    for (const LidarPoint& point : lidar.Sweep(T_lidar_board, 0).points) {
      const OnPlane place = MeetPlane(T_lidar_board, BeamOf(point));
      const double range_m = point.position_m.cast<double>().norm();
      if (InsideM(place, rig.board) > 1e-6) {
        ++num_on_board;
        ASSERT_NEAR(range_m, place.range_m, kFloatM);
      } else if (const double inside_m = InsideM(place, rig.board);
                 inside_m < -1e-6 && inside_m > -kAroundM) {
        ASSERT_GT(std::abs(range_m - place.range_m), 1e-4);
      }
    }
    // Area over the solid angle of a beam's cell, at 4.5 m and 55 degrees: 0.52 * 0.57 / (4.5^2) /
    // (0.0349 * 0.00349) = 120.
    EXPECT_GT(num_on_board, 100);
  }
}

TEST(Sweep, MeetsTheWallsWhereTheyAre) {
  const test::SimulatedRig rig = test::CleanRig();
  Eigen::Isometry3d T_lidar_board = StopOf(rig, 0);
  int num_at_shell = 0;
  for (const LidarPoint& point : SimulatorOf(rig).Sweep(T_lidar_board, 0).points) {
    const Eigen::Vector3d direction = BeamOf(point);
    double exit_m = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double low[] = {-4.0, -4.0, -1.2};
      const double high[] = {6.0, 4.0, 1.8};
      const double wall_m = direction[axis] > 0 ? high[axis] : low[axis];
      if (direction[axis] != 0) exit_m = std::min(exit_m, wall_m / direction[axis]);
    }
    const Eigen::Vector3d position_m = point.position_m.cast<double>();
    if (std::abs(position_m.norm() - exit_m) < kFloatM) ++num_at_shell;
    if (position_m.norm() > exit_m + kFloatM) {  // only into the recess of the door
      ASSERT_GT(position_m.x(), 6.0);
      ASSERT_LT(position_m.x(), 6.25 + kFloatM);
      ASSERT_NEAR(position_m.y(), -1.8, 0.5 + kFloatM);
      ASSERT_LT(position_m.z(), 0.9 + kFloatM);
    }
  }
  EXPECT_GT(num_at_shell, kNumBeams / 2);
  EXPECT_LT(num_at_shell, kNumBeams - 3000);  // furniture and board are there
}

TEST(Sweep, RangeNoiseHasItsSigma) {
  test::SimulatedRig rig = test::CleanRig();
  const Eigen::Isometry3d T_lidar_board = StopOf(rig, 0);
  const auto clean_m = RangesOf(SimulatorOf(rig).Sweep(T_lidar_board, 0));
  rig.options.range_noise_m = 0.01;
  const LidarSimulator noisy = SimulatorOf(rig);
  const auto first_m = RangesOf(noisy.Sweep(T_lidar_board, 0));
  const auto second_m = RangesOf(noisy.Sweep(T_lidar_board, 100000));
  double mean_m = 0.0;
  double square = 0.0;
  double product = 0.0;
  for (const auto& [beam, range_m] : clean_m) {
    const double first_error_m = first_m.at(beam) - range_m;
    mean_m += first_error_m / kNumBeams;
    square += first_error_m * first_error_m / kNumBeams;
    product += first_error_m * (second_m.at(beam) - range_m) / kNumBeams;
  }
  // Four standard errors over 28,800 beams: sigma / 170, sigma / 240; a correlation: 1 / 170.
  EXPECT_NEAR(mean_m, 0.0, 4 * 0.01 / 170);
  EXPECT_NEAR(std::sqrt(square), 0.01, 4 * 0.01 / 240);
  EXPECT_NEAR(product / square, 0.0, 4.0 / 170);
}

TEST(Sweep, RingBiasIsConstantAndDrawnBySeed) {
  test::SimulatedRig rig = test::CleanRig();
  const Eigen::Isometry3d T_lidar_board = StopOf(rig, 0);
  const auto clean_m = RangesOf(SimulatorOf(rig).Sweep(T_lidar_board, 0));
  rig.options.ring_bias_m = 0.008;
  rig.options.common_bias_m = 0.02;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    rig.options.seed = seed;
    const auto biased_m = RangesOf(SimulatorOf(rig).Sweep(T_lidar_board, 0));
    for (int ring = 0; ring < 16; ++ring) {
      const double bias_m = biased_m.at(ring) - clean_m.at(ring) - 0.02;
      ASSERT_NEAR(biased_m.at(16000 + ring) - clean_m.at(16000 + ring) - 0.02, bias_m, 2 * kFloatM);
      sum += bias_m / 320;
      sum_of_squares += bias_m * bias_m / 320;
    }
  }
  // Four standard errors over 320 draws: sigma / 17.9, sigma / 25.3.
  EXPECT_NEAR(sum, 0.0, 4 * 0.008 / 17.9);
  EXPECT_NEAR(std::sqrt(sum_of_squares), 0.008, 4 * 0.008 / 25.3);
}

TEST(Sweep, DarkAndBrightSquaresReadDifferently) {
  test::SimulatedRig rig = test::CleanRig();
  rig.options.dark_bias_m = 0.0075;
  const Eigen::Isometry3d T_lidar_board = StopOf(rig, 1);
  const Eigen::Vector3d first_corner_m = rig.board.InnerCornersBoardM().front();
  int num_dark = 0;
  int num_bright = 0;
  for (const LidarPoint& point : SimulatorOf(rig).Sweep(T_lidar_board, 0).points) {
    const OnPlane place = MeetPlane(T_lidar_board, BeamOf(point));
    if (InsideM(place, rig.board) < 1e-6) continue;
    // Squares counted from the first inner corner; the square below and left of it, (-1, -1), is
    // dark.
    const double i = std::floor((place.x_m - first_corner_m.x()) / rig.board.square_m);
    const double j = std::floor((place.y_m - first_corner_m.y()) / rig.board.square_m);
    const bool is_in_pattern =
        i >= -1 && j >= -1 && i < rig.board.num_corners_x && j < rig.board.num_corners_y;
    const bool is_dark = is_in_pattern && std::fmod(i + j + 2, 2.0) == 0.0;
    (is_dark ? num_dark : num_bright)++;
    const double range_m = point.position_m.cast<double>().norm();
    ASSERT_NEAR(range_m - place.range_m, is_dark ? 0.0075 : -0.0075, kFloatM);
    ASSERT_NEAR(point.intensity, is_dark ? 8.0 : 80.0, 1e-4);
  }
  EXPECT_GT(num_dark, 50);
  EXPECT_GT(num_bright, 50);
}

TEST(Sweep, BeamsMixOnlyAtEdges) {
  test::SimulatedRig rig = test::CleanRig();
  const Eigen::Isometry3d T_lidar_board = StopOf(rig, 2);
  const auto thin_m = RangesOf(SimulatorOf(rig).Sweep(T_lidar_board, 0));
  rig.options.beam_divergence_rad = 0.003;
  int num_bloomed = 0;  // answered by the board although their centre misses it
  int num_blended = 0;  // neither on the board nor where the thin beam ends
  for (const LidarPoint& point : SimulatorOf(rig).Sweep(T_lidar_board, 0).points) {
    const OnPlane place = MeetPlane(T_lidar_board, BeamOf(point));
    const double range_m = point.position_m.cast<double>().norm();
    // On the board's plane the beam has this half-width, lengthened by a tilt of 55 degrees at
    // most.
    const double half_width_m = 0.0015 * place.range_m / std::cos(55 * M_PI / 180);
    const double inside_m = InsideM(place, rig.board);
    if (inside_m > half_width_m) {
      ASSERT_NEAR(range_m, place.range_m, kFloatM);
    } else if (inside_m > -half_width_m) {
      const bool is_on_board = std::abs(range_m - place.range_m) < half_width_m * 1.5;
      if (is_on_board && inside_m < 0) ++num_bloomed;
      if (!is_on_board && std::abs(range_m - thin_m.at(BeamNumber(point))) > 0.005) ++num_blended;
    } else if (inside_m > -kAroundM) {
      ASSERT_GT(std::abs(range_m - place.range_m), 1e-4);
    }
  }
  EXPECT_GT(num_bloomed, 0);
  EXPECT_LT(num_blended, 40);
}

TEST(Sweep, SmallStepsBlend) {
  // 0.2 m between the edges of a board and a wall behind it: some beams answer in between.
  test::SimulatedRig rig = test::CleanRig();
  rig.options.beam_divergence_rad = 0.003;
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  T_lidar_board.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // facing +x
  T_lidar_board.translation() = Eigen::Vector3d(-3.8, 0.0, 0.1);
  int num_between = 0;
  for (const LidarPoint& point : SimulatorOf(rig).Sweep(T_lidar_board, 0).points) {
    const bool is_beside = std::abs(point.position_m.z() - 0.1F) < 0.3F &&
                           std::abs(point.position_m.y()) < 0.35F && point.position_m.x() < 0;
    if (!is_beside) continue;
    if (point.position_m.x() < -3.81F && point.position_m.x() > -3.99F) ++num_between;
  }
  EXPECT_GT(num_between, 4);
}

TEST(Sweep, DropsItsShareOfBeams) {
  test::SimulatedRig rig = test::CleanRig();
  rig.options.dropout = 0.05;
  const auto num = static_cast<double>(SimulatorOf(rig).Sweep(StopOf(rig, 0), 0).points.size());
  // Binomial: sqrt(28800 * 0.05 * 0.95) = 37; allow 4 of them.
  EXPECT_NEAR(num, kNumBeams * 0.95, 4 * 37);
}

// What the mask of rays and solids saves must not change what a beam sees: whole beams against
// their own centre ray, in a room full of things.
TEST(Sweep, OfEveryPatternMeetsBoardAndClutterExactly) {
  VOQCAL_LEAVE_TO_RELEASE();
  for (const ScanPattern pattern : {ScanPattern::kSpinning64,
                                    ScanPattern::kSpinning128,
                                    ScanPattern::kRaster,
                                    ScanPattern::kRosette}) {
    test::SimulatedRig rig = test::CleanRig();
    rig.options.scan.pattern = pattern;
    const Room room(DrawClutter({}, rig.board, Room().Interior(), 3));
    const Eigen::Isometry3d T_lidar_board = StopOf(rig, 0);
    const LidarSimulator lidar(rig.options, rig.board, room);
    const PointCloud cloud = lidar.Sweep(T_lidar_board, 300000);
    const auto beams = BeamsOfSweep(rig.options.scan, 300000);
    ASSERT_EQ(cloud.points.size(), beams.size());
    EXPECT_EQ(cloud.has_ring, HasRings(pattern));
    BoardHits hits;
    std::set<int> rings;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const RoomHit room_hit = room.Cast(Eigen::Vector3d::Zero(), beams[i].direction);
      const OnPlane place = MeetPlane(T_lidar_board, beams[i].direction);
      const double range_m = cloud.points[i].position_m.cast<double>().norm();
      ASSERT_EQ(cloud.points[i].time_s, beams[i].time_s);
      if (InsideM(place, rig.board) > 0 && place.range_m < room_hit.range_m) {
        ++hits.num_points;
        rings.insert(beams[i].emitter);
        ASSERT_NEAR(range_m, place.range_m, 2 * kFloatM) << ToString(pattern);
      } else {
        ASSERT_LT(range_m, room_hit.range_m + 2 * kFloatM) << ToString(pattern);  // or the stand
      }
    }
    const BoardHits counted = lidar.CountBoardHits(T_lidar_board, 300000);
    EXPECT_GT(counted.num_points, 100) << ToString(pattern);
    EXPECT_EQ(counted.num_points, hits.num_points) << ToString(pattern);
    EXPECT_EQ(counted.num_rings, HasRings(pattern) ? static_cast<int>(rings.size()) : 0);
  }
}

}  // namespace
}  // namespace voqcal
