#include "core/lidar_detection/accumulating_detector.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simulation/scan_pattern.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

constexpr std::int64_t kSweepUs = 100000;

const BoardSpec kBoard{0.4, 0.56, 0.06, 5, 7, 0.0, 0.0};

const Eigen::Isometry3d kFarAway = test::FacingBoard({7.0, 0.5, 0.2}, 30, 15, -10);

/// What a lidar of a tenth of the pattern's beams sees of the board before a wall 1.5 m behind it,
/// with 10 mm of noise: of the rosette ten returns or so a sweep. Beams far from the board are
/// left out.
PointCloud SweepOf(ScanPattern pattern,
                   const Eigen::Isometry3d& T_lidar_board,
                   std::int64_t utime) {
  const double cone = std::cos(0.2);
  const test::SyntheticBox board{T_lidar_board, {kBoard.width_m / 2, kBoard.height_m / 2, 1e-3}};
  std::mt19937 random(static_cast<std::uint32_t>(utime / kSweepUs));
  ScanOptions scan;
  scan.pattern = pattern;
  PointCloud cloud;
  std::size_t num = 0;
  for (const ScanBeam& beam : BeamsOfSweep(scan, utime)) {
    if (num++ % 10 != 0) continue;
    if (beam.direction.dot(kFarAway.translation().normalized()) < cone) continue;
    const double to_wall_m = 8.5 / beam.direction.x();
    const double range_m = std::min(test::RangeToBox(board, beam.direction), to_wall_m) +
                           0.01 * test::UnitGaussian(&random);
    LidarPoint point;
    point.position_m = (range_m * beam.direction).cast<float>();
    cloud.points.push_back(point);
  }
  return cloud;
}

Eigen::Isometry3d MovedBy(const Eigen::Vector3d& shift_m) {
  Eigen::Isometry3d T_lidar_board = kFarAway;
  T_lidar_board.translation() += shift_m;
  return T_lidar_board;
}

/// After `num_before` sweeps of the board elsewhere, `num` where it is.
LidarBoardSighting SightRosette(const LidarBoardOptions& options,
                                int num_before,
                                const Eigen::Vector3d& from_m,
                                int num) {
  AccumulatingDetector detector(kBoard, options);
  LidarBoardSighting sighting{NoLidarBoard{}};
  for (int i = 0; i < num_before + num; ++i) {
    const Eigen::Isometry3d T_lidar_board = i < num_before ? MovedBy(from_m) : kFarAway;
    sighting =
        detector.Detect(SweepOf(ScanPattern::kRosette, T_lidar_board, i * kSweepUs), i * kSweepUs);
  }
  return sighting;
}

double CentreErrorM(const LidarBoardSighting& sighting) {
  return (sighting.boards->front().pose.centre_m - kFarAway.translation()).norm();
}

TEST(AccumulatingDetector, FindsInTenSweepsWhatOneIsTooThinFor) {
  const LidarBoardSighting alone = SightRosette({}, 0, Eigen::Vector3d::Zero(), 1);
  EXPECT_FALSE(alone.boards) << alone.boards->front().points_lidar_m.points.size();
  EXPECT_EQ(alone.accumulated_us, 0);
  const LidarBoardSighting ten = SightRosette({}, 0, Eigen::Vector3d::Zero(), 10);
  ASSERT_TRUE(ten.boards) << ToString(ten.boards.error());
  EXPECT_GT(ten.accumulated_us, 0);
  EXPECT_LT(ten.accumulated_us, 10 * kSweepUs);
  const BoardPose& pose = ten.boards->front().pose;
  const double sigma_m = std::sqrt(pose.covariance.bottomRightCorner<3, 3>().trace());
  EXPECT_LT(sigma_m, 0.02);
  EXPECT_LT(CentreErrorM(ten), 3 * sigma_m);
}

TEST(AccumulatingDetector, LeavesOutTheTimeBeforeTheBoardCameToRest) {
  // Half a board aside: sweeps of both places together show neither.
  const LidarBoardSighting sighting = SightRosette({}, 4, {0.0, 0.25, 0.0}, 6);
  ASSERT_TRUE(sighting.boards) << ToString(sighting.boards.error());
  EXPECT_LT(sighting.accumulated_us, 6 * kSweepUs);
  EXPECT_LT(CentreErrorM(sighting), 0.05);
}

TEST(AccumulatingDetector, TakesNoBoardThatStandsElsewhereInTheNewerHalf) {
  for (const Eigen::Vector3d& from_m :
       {Eigen::Vector3d(0.0, 0.08, 0.0), Eigen::Vector3d(0.06, 0.0, 0.0)}) {
    const LidarBoardSighting sighting = SightRosette({}, 5, from_m, 5);
    if (sighting.boards) {
      EXPECT_LT(sighting.accumulated_us, 5 * kSweepUs) << from_m.transpose();
    }
  }
}

TEST(AccumulatingDetector, TakesALidarThatRepeatsItsBeamsAsItIs) {
  AccumulatingDetector detector(kBoard, {});
  for (int i = 0; i < 4; ++i) {
    const auto sighting =
        detector.Detect(SweepOf(ScanPattern::kVlp16, kFarAway, i * kSweepUs), i * kSweepUs);
    EXPECT_FALSE(sighting.boards);
    EXPECT_EQ(sighting.accumulated_us, 0);
  }
}

/// A wall as 16 rings meet it, fired each 0.4 degrees from `first_deg` on: a VLP-16 at 20 Hz, whose
/// firings follow a clock and not the head's angle.
PointCloud FreelyTurningSweep(double first_deg) {
  constexpr double kDeg = M_PI / 180.0;
  PointCloud cloud;
  for (double azimuth_deg = -30.0 + first_deg; azimuth_deg < 30.0; azimuth_deg += 0.4) {
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = (2 * ring - 15) * kDeg;
      LidarPoint point;
      point.position_m = 8.0F * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth_deg * kDeg),
                                                std::cos(elevation) * std::sin(azimuth_deg * kDeg),
                                                std::sin(elevation))
                                    .cast<float>();
      cloud.points.push_back(point);
    }
  }
  return cloud;
}

TEST(AccumulatingDetector, KnowsALidarThatTurnsFreely) {
  for (const double aside_deg : {0.1, 0.2, 0.3}) {
    AccumulatingDetector detector(kBoard, {});
    detector.Detect(FreelyTurningSweep(0.0), 0);
    EXPECT_FALSE(detector.is_repeating());
    detector.Detect(FreelyTurningSweep(aside_deg), kSweepUs / 2);
    EXPECT_EQ(detector.is_repeating(), std::optional<bool>(true)) << aside_deg;
  }
}

TEST(AccumulatingDetector, IsToldNothingByASweepThatIsSentTwice) {
  AccumulatingDetector detector(kBoard, {});
  detector.Detect(FreelyTurningSweep(0.0), 0);
  detector.Detect(FreelyTurningSweep(0.0), kSweepUs);
  EXPECT_FALSE(detector.is_repeating());
  detector.Detect(FreelyTurningSweep(0.2), 2 * kSweepUs);
  EXPECT_TRUE(detector.is_repeating());
}

TEST(AccumulatingDetector, GoesNoFurtherBackThanItIsAllowed) {
  LidarBoardOptions options;
  options.max_accumulation_s = 0.0;
  EXPECT_FALSE(SightRosette(options, 0, Eigen::Vector3d::Zero(), 10).boards);
  options.max_accumulation_s = 0.5;
  EXPECT_LT(SightRosette(options, 0, Eigen::Vector3d::Zero(), 10).accumulated_us, 5 * kSweepUs);
  options.max_accumulation_s = -1.0;
  EXPECT_THROW(AccumulatingDetector(kBoard, options), std::invalid_argument);
  EXPECT_THAT(options.Problems(),
              testing::ElementsAre(testing::HasSubstr("max_accumulation_s must be from 0 to 10")));
}

TEST(AccumulatingDetector, BeginsAnewWhereTimeGoesBack) {
  AccumulatingDetector detector(kBoard, {});
  for (int i = 0; i < 10; ++i) {
    detector.Detect(SweepOf(ScanPattern::kRosette, kFarAway, i * kSweepUs), i * kSweepUs);
  }
  const auto sighting = detector.Detect(SweepOf(ScanPattern::kRosette, kFarAway, 0), 0);
  EXPECT_EQ(sighting.accumulated_us, 0);
  EXPECT_FALSE(sighting.boards);
}

}  // namespace
}  // namespace voqcal
