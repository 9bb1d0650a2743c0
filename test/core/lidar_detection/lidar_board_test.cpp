#include "core/lidar_detection/lidar_board.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticBox;
using test::SyntheticLidarBoardOptions;

SyntheticLidarBoardOptions Diamond() {
  SyntheticLidarBoardOptions scene;
  scene.T_lidar_board = FacingBoard({2.3, 0.4, -0.1}, 40.0, 20.0, 10.0);
  return scene;
}

SyntheticBox Box(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& half_m) {
  SyntheticBox box;
  box.T_lidar_box.translation() = middle_m;
  box.half_m = half_m;
  return box;
}

std::string MissOf(const SyntheticLidarBoardOptions& scene) {
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), scene.board, {});
  return found ? "found" : ToString(found.error());
}

void ExpectFound(const PointCloud& cloud,
                 const SyntheticLidarBoardOptions& scene,
                 double centre_tol_m,
                 double angle_tol_rad) {
  const auto found = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_TRUE(found) << ToString(found.error());
  const BoardPose& pose = found->front().pose;
  EXPECT_LT((pose.centre_m - scene.T_lidar_board.translation()).norm(), centre_tol_m);
  EXPECT_LT(AngleBetween(pose.normal, scene.T_lidar_board.linear().col(2)), angle_tol_rad);
  EXPECT_LT(RotationAngleBetween(TransformFromPose(pose).linear(), scene.T_lidar_board.linear()),
            2 * angle_tol_rad);
}

// An edge is known to within the beams' spacing, 8 mm, at each of the 8 places or so where a scan
// line crosses it: about 8 / sqrt(12 * 8) = 1 mm. Allow 3 mm; and 3 mm over half a board is 10
// mrad.
constexpr double kSpacingTolM = 0.003;
constexpr double kSpacingTolRad = 0.01;

TEST(DetectLidarBoard, FindsBoardInCleanSweep) {
  const SyntheticLidarBoardOptions scene = Diamond();
  ExpectFound(SynthesizeLidarBoard(scene), scene, kSpacingTolM, kSpacingTolRad);
}

TEST(DetectLidarBoard, FindsBoardAtManyPoses) {
  SyntheticLidarBoardOptions scene;
  for (const double roll_deg : {-50.0, 35.0}) {
    for (const double tilt_deg : {-35.0, 35.0}) {
      for (const double x_m : {1.8, 2.6, 3.4}) {
        SCOPED_TRACE(testing::Message() << roll_deg << ' ' << tilt_deg << ' ' << x_m);
        scene.T_lidar_board = FacingBoard({x_m, -0.3 * x_m, -0.1}, roll_deg, tilt_deg);
        // At 3.4 m half as many scan lines, twice as far apart.
        ExpectFound(SynthesizeLidarBoard(scene), scene, 2 * kSpacingTolM, 2 * kSpacingTolRad);
      }
    }
  }
}

TEST(DetectLidarBoard, FindsBoardInDenseSweeps) {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.01;
  for (const int num_rings : {64, 128}) {
    for (const double x_m : {1.5, 3.0, 6.0}) {
      SCOPED_TRACE(testing::Message() << num_rings << ' ' << x_m);
      scene.num_rings = num_rings;
      scene.T_lidar_board = FacingBoard({x_m, 0.1 * x_m, -0.1}, 40.0, 20.0, 10.0);
      // At 6 m beams are 21 mm apart along a ring, and a board has 20 rings at least: 21 / sqrt(12
      // * 20) = 1.4 mm; the plane of 200 points tilts by 10 mm / (180 mm * sqrt(200)) = 4 mrad.
      ExpectFound(SynthesizeLidarBoard(scene), scene, 2 * kSpacingTolM, 2 * kSpacingTolRad);
    }
  }
}

struct SizeAtRange {
  double width_m;
  double height_m;
  double range_m;
};

// 0.2 degrees apart, 128 scan lines in 30: 7 cm and 8 cm at 20 m.
TEST(DetectLidarBoard, FindsBoardsOfAllSizesNearAndFar) {
  for (const SizeAtRange& at : {SizeAtRange{0.3, 0.4, 0.8},
                                SizeAtRange{0.3, 0.4, 3.0},
                                SizeAtRange{0.6, 0.6, 1.5},
                                SizeAtRange{0.6, 0.8, 10.0},
                                SizeAtRange{1.2, 1.2, 3.0},
                                SizeAtRange{1.2, 1.2, 19.0}}) {
    SCOPED_TRACE(testing::Message() << at.width_m << " x " << at.height_m << " at " << at.range_m);
    SyntheticLidarBoardOptions scene;
    scene.board = {at.width_m, at.height_m, 0.05, 4, 5, 0.0, 0.0};
    scene.T_lidar_board = FacingBoard({at.range_m, 0.1, 0.0}, 35.0, 15.0, 10.0);
    scene.num_rings = 128;
    scene.noise_m = 0.005;
    scene.has_wall = at.range_m < 6.0;
    const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), scene.board, {});
    ASSERT_TRUE(found) << ToString(found.error());
    const BoardPose& pose = found->front().pose;
    const Eigen::Vector3d error_m = pose.centre_m - scene.T_lidar_board.translation();
    const Eigen::Matrix3d covariance = pose.covariance.bottomRightCorner<3, 3>();
    EXPECT_LT(error_m.norm(), 0.03);
    EXPECT_LT(error_m.dot(covariance.ldlt().solve(error_m)), 14.2);  // one in 400
  }
}

TEST(DetectLidarBoard, ErrorStaysWithinItsCovariance) {
  SyntheticLidarBoardOptions scene = Diamond();
  for (const double noise_m : {0.005, 0.015}) {
    scene.noise_m = noise_m;
    double sum_squares = 0.0;
    constexpr int kNumTrials = 8;
    for (int trial = 0; trial < kNumTrials; ++trial) {
      scene.seed = static_cast<std::uint32_t>(trial + 1);
      const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), scene.board, {});
      ASSERT_TRUE(found) << ToString(found.error());
      const BoardPose& pose = found->front().pose;
      const Vector6d error = DifferenceLeft(TransformFromPose(pose), scene.T_lidar_board);
      sum_squares += error.dot(pose.covariance.ldlt().solve(error));
    }
    // Mean of 8 draws of chi-squared with 6 degrees: 6 +- 1.2. The covariance is only approximately
    // that of the sampling error, so a factor of two either way in sigma.
    EXPECT_LT(sum_squares / kNumTrials, 4 * 6.0);
    EXPECT_GT(sum_squares / kNumTrials, 6.0 / 8);
  }
}

TEST(DetectLidarBoard, MeasuresEdgesFreely) {
  SyntheticLidarBoardOptions scene = Diamond();
  const BoardSpec nominal = scene.board;
  constexpr double kWiderM = 0.02;  // than it is said to be
  scene.board.width_m += kWiderM;
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), nominal, {});
  ASSERT_TRUE(found) << ToString(found.error());
  const auto& lengths_m = found->front().edge_lengths_m;
  // Two lines, each at kSpacingTolM; the prior of 10 mm thickness takes up to 10 mm * tan(20 deg).
  EXPECT_NEAR(lengths_m[0], nominal.width_m + kWiderM, 4 * kSpacingTolM);
  EXPECT_NEAR(lengths_m[2], nominal.width_m + kWiderM, 4 * kSpacingTolM);
  EXPECT_NEAR(lengths_m[1], nominal.height_m, 4 * kSpacingTolM);
  EXPECT_NEAR(lengths_m[3], nominal.height_m, 4 * kSpacingTolM);
}

TEST(DetectLidarBoard, ThicknessDoesNotShiftTheCentre) {
  SyntheticLidarBoardOptions scene = Diamond();
  scene.thickness_m = 0.025;
  scene.T_lidar_board = FacingBoard({2.3, 0.4, -0.1}, 40.0, 40.0);
  // Unmodelled it would shift the centre by 25 * tan(40 deg) / 2 = 10 mm.
  ExpectFound(SynthesizeLidarBoard(scene), scene, 0.005, 2 * kSpacingTolRad);
}

TEST(DetectLidarBoard, NeedsNeitherWallNorFloorBehind) {
  SyntheticLidarBoardOptions scene = Diamond();
  scene.has_wall = false;
  scene.has_floor = false;
  // Only hits, up to one spacing short of each edge: the spill's prior and the known size remain.
  ExpectFound(SynthesizeLidarBoard(scene), scene, 0.012, 3 * kSpacingTolRad);
}

TEST(DetectLidarBoard, FindsBoardThatPersonAndPoleTouch) {
  SyntheticLidarBoardOptions scene = Diamond();
  scene.noise_m = 0.01;
  const Eigen::Vector3d centre_m = scene.T_lidar_board.translation();
  scene.boxes.push_back(Box(centre_m + Eigen::Vector3d(0, 0, -0.85), {0.02, 0.02, 0.4}));
  scene.boxes.push_back(Box(centre_m + Eigen::Vector3d(0.25, 0.55, -0.3), {0.12, 0.2, 0.8}));
  // Part of one side has no misses: the centre is held by fewer beams.
  ExpectFound(SynthesizeLidarBoard(scene), scene, 0.010, 3 * kSpacingTolRad);
}

/// A bar in its plane along the whole upper edge, as an easel has; the post that it hangs on goes
/// on above it or is not seen.
SyntheticLidarBoardOptions BoardUnderABar(double bar_m, bool has_post) {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.005;
  scene.num_rings = 64;
  scene.T_lidar_board = FacingBoard({2.3, 0.0, 0.0}, 0.0);
  const double top_m = scene.board.height_m / 2;
  scene.boxes.push_back(Box({2.304, 0.0, top_m + bar_m / 2}, {0.004, 0.305, bar_m / 2}));
  if (has_post) scene.boxes.push_back(Box({2.304, 0.0, top_m + bar_m + 0.3}, {0.004, 0.04, 0.3}));
  return scene;
}

TEST(DetectLidarBoard, ABarAlongASideDoesNotMoveIt) {
  const SyntheticLidarBoardOptions scene = BoardUnderABar(0.05, /*has_post=*/true);
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), scene.board, {});
  ASSERT_TRUE(found) << ToString(found.error());
  EXPECT_EQ(found->front().sides[2], SideView::kJoined);
  EXPECT_EQ(NumMeasuredSides(found->front()), 3);
  EXPECT_LT((found->front().pose.centre_m - scene.T_lidar_board.translation()).norm(), 0.01);
}

// Unless the board is expected there, such a board is of another size.
TEST(DetectLidarBoard, ABarThatNothingTellsIsInTheCovariance) {
  const SyntheticLidarBoardOptions scene = BoardUnderABar(0.05, /*has_post=*/false);
  EXPECT_EQ(MissOf(scene), "size mismatch");
  BoardPrior prior;
  prior.T_lidar_board = scene.T_lidar_board;
  prior.covariance = 4e-4 * Matrix6d::Identity();
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), scene.board, {}, nullptr, prior);
  ASSERT_TRUE(found) << ToString(found.error());
  const BoardPose& pose = found->front().pose;
  const double sigma_m = std::sqrt(pose.covariance(5, 5));
  EXPECT_GT(pose.centre_m.z(), 0.01);  // half the bar too high
  EXPECT_GT(sigma_m, 0.01);
  EXPECT_LT(pose.centre_m.z(), 2 * sigma_m);
}

TEST(DetectLidarBoard, NeedsNoRingsIntensityOrOrder) {
  const SyntheticLidarBoardOptions scene = Diamond();
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  PointCloud bare;
  for (auto point = cloud.points.rbegin(); point != cloud.points.rend(); ++point) {
    bare.points.emplace_back().position_m = point->position_m;
  }
  std::mt19937 random(3);
  for (std::size_t i = bare.points.size() - 1; i > 0; --i) {
    std::swap(bare.points[i], bare.points[random() % (i + 1)]);
  }
  const auto ordered = DetectLidarBoard(cloud, scene.board, {});
  const auto shuffled = DetectLidarBoard(bare, scene.board, {});
  ASSERT_TRUE(ordered && shuffled);
  // The scan lines are told from the geometry.
  EXPECT_NEAR(shuffled->front().num_beams, ordered->front().num_beams, 1);
  EXPECT_GT(ordered->front().num_beams, 5);
  // The first rough fit looks at every n-th beam; the last one at all, so only its tolerance is
  // left.
  EXPECT_LT((ordered->front().pose.centre_m - shuffled->front().pose.centre_m).norm(), 1e-3);
}

TEST(DetectLidarBoard, SameSweepSameAnswer) {
  SyntheticLidarBoardOptions scene = Diamond();
  scene.noise_m = 0.01;
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  const auto a = DetectLidarBoard(cloud, scene.board, {});
  const auto b = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->front().pose.centre_m, b->front().pose.centre_m);
  EXPECT_EQ(a->front().pose.covariance, b->front().pose.covariance);
  EXPECT_EQ(a->front().edge_lengths_m, b->front().edge_lengths_m);
}

TEST(DetectLidarBoard, RegionOfInterestNarrowsTheSearch) {
  const SyntheticLidarBoardOptions scene = Diamond();
  LidarBoardOptions options;
  options.region_of_interest = RegionOfInterest{{1, -1, -1}, {3, 1.5, 1}};
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  EXPECT_TRUE(DetectLidarBoard(cloud, scene.board, options));
  options.region_of_interest = RegionOfInterest{{1, -3, -1}, {3, -1, 1}};
  EXPECT_FALSE(DetectLidarBoard(cloud, scene.board, options));
}

TEST(DetectLidarBoard, WrongSizedBoardIsNotTaken) {
  SyntheticLidarBoardOptions scene = Diamond();
  SyntheticLidarBoardOptions other = scene;
  other.board.width_m = 0.6;
  other.board.height_m = 0.55;
  EXPECT_EQ("found", MissOf(scene));
  const auto alone = DetectLidarBoard(SynthesizeLidarBoard(other), scene.board, {});
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().miss, LidarBoardMiss::kSizeMismatch);
  SyntheticBox square;
  square.T_lidar_box = FacingBoard({2.2, -1.2, -0.1}, 40.0);
  square.half_m = {0.3, 0.28, 0.005};
  scene.boxes.push_back(square);
  ExpectFound(SynthesizeLidarBoard(scene), scene, kSpacingTolM, kSpacingTolRad);
}

TEST(DetectLidarBoard, TwoBoardsAreAmbiguous) {
  SyntheticLidarBoardOptions scene = Diamond();
  SyntheticBox twin;
  twin.T_lidar_box = FacingBoard({2.3, -1.2, -0.1}, 40.0);
  twin.half_m = {0.305, 0.425, 0.001};
  scene.boxes.push_back(twin);
  EXPECT_EQ("ambiguous", MissOf(scene));
}

TEST(DetectLidarBoard, SweepWithoutBoardHasNoPlane) {
  SyntheticLidarBoardOptions scene;
  scene.has_board = false;
  EXPECT_EQ("no plane of the board's size", MissOf(scene));
}

TEST(DetectLidarBoard, EmptyAndBrokenCloudsHaveTooFewPoints) {
  const SyntheticLidarBoardOptions scene;
  PointCloud cloud;
  const auto empty = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().miss, LidarBoardMiss::kTooFewPoints);
  cloud.points.resize(1000);  // at the origin: no returns
  for (std::size_t i = 0; i < 500; ++i) {
    cloud.points[i].position_m.setConstant(i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                      : std::numeric_limits<float>::infinity());
  }
  const auto broken = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().miss, LidarBoardMiss::kTooFewPoints);
}

TEST(DetectLidarBoard, NamesBadOptions) {
  LidarBoardOptions options;
  options.min_range_m = -1.0;
  options.max_range_m = -2.0;
  options.region_of_interest = RegionOfInterest{{0, 0, 0}, {1, 1, -1}};
  EXPECT_THAT(options.Problems(),
              testing::ElementsAre("min_range_m must not be negative, is -1",
                                   "max_range_m must be finite and above min_range_m, is -2",
                                   "region_of_interest max must be above min on axis z, is -1"));
  options = {};
  options.max_bend_m = 0.0;
  options.beam.hit_band_m = 0.0;
  options.background.memory_sweeps = 0;
  EXPECT_THAT(options.Problems(),
              testing::ElementsAre("max_bend_m must be positive, is 0",
                                   "beam: hit_band_m must be positive, is 0",
                                   "background: memory_sweeps must be positive, is 0"));
  EXPECT_THROW((void)DetectLidarBoard({}, SyntheticLidarBoardOptions().board, options),
               std::invalid_argument);
  EXPECT_THROW((void)DetectLidarBoard({}, BoardSpec(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
