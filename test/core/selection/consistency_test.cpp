#include "core/selection/consistency.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<BoardSample> Scene(int num_samples, int num_outliers, std::uint32_t seed = 1) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.num_outliers = num_outliers;
  scene.lidar_centre_noise_m = 0.005;
  scene.lidar_rotation_noise_rad = 0.008;
  scene.seed = seed;
  return test::SynthesizeSamples(scene);
}

TEST(FindConsistent, KeepsNoisySamples) {
  const Consistency found = FindConsistent(Scene(30, 0), {});
  EXPECT_EQ(found.consistent.size(), 30u);
  EXPECT_THAT(found.inconsistent, IsEmpty());
}

TEST(FindConsistent, FindsTenToThirtyPercentOutliers) {
  for (const int num_outliers : {3, 6, 9}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const Consistency found = FindConsistent(Scene(30, num_outliers, seed), {});
      ASSERT_EQ(found.inconsistent.size(), static_cast<std::size_t>(num_outliers)) << seed;
      for (int i = 0; i < num_outliers; ++i) {
        EXPECT_EQ(found.inconsistent[static_cast<std::size_t>(i)].sample, i);
      }
      EXPECT_EQ(found.consistent.size(), static_cast<std::size_t>(30 - num_outliers));
    }
  }
}

TEST(FindConsistent, DoesNotDependOnTheOrder) {
  auto samples = Scene(20, 4);
  std::reverse(samples.begin(), samples.end());
  const Consistency found = FindConsistent(samples, {});
  ASSERT_EQ(found.inconsistent.size(), 4u);
  for (const InconsistentSample& wrong : found.inconsistent) EXPECT_GE(wrong.sample, 16);
}

TEST(FindConsistent, SaysWhy) {
  auto samples = Scene(10, 0);
  samples[4].lidar.pose.centre_m *= 1.5;
  const Consistency found = FindConsistent(samples, {});
  ASSERT_EQ(found.inconsistent.size(), 1u);
  EXPECT_EQ(found.inconsistent[0].sample, 4);
  EXPECT_THAT(found.inconsistent[0].reason, HasSubstr("of 9 consistent samples"));
  EXPECT_THAT(found.inconsistent[0].reason, HasSubstr("mm (limit 60.0)"));
}

TEST(FindConsistent, FindsAWrongNormal) {
  auto samples = Scene(10, 0);
  samples[7].lidar.pose.normal = -samples[7].lidar.pose.normal;
  const Consistency found = FindConsistent(samples, {});
  ASSERT_EQ(found.inconsistent.size(), 1u);
  EXPECT_EQ(found.inconsistent[0].sample, 7);
}

TEST(FindConsistent, TakesNanForWrong) {
  auto samples = Scene(10, 0);
  samples[2].lidar.pose.normal.setConstant(std::numeric_limits<double>::quiet_NaN());
  samples[3].camera.pose.centre_m.x() = std::numeric_limits<double>::quiet_NaN();
  const Consistency found = FindConsistent(samples, {});
  EXPECT_THAT(found.consistent, ElementsAre(0, 1, 4, 5, 6, 7, 8, 9));
}

TEST(FindConsistent, FindsOutliersAmongManySamples) {
  for (const int num_outliers : {20, 40, 60}) {
    const Consistency found = FindConsistent(Scene(200, num_outliers), {});
    ASSERT_EQ(found.inconsistent.size(), static_cast<std::size_t>(num_outliers));
    for (int i = 0; i < num_outliers; ++i) {
      EXPECT_EQ(found.inconsistent[static_cast<std::size_t>(i)].sample, i);
    }
  }
}

TEST(FindConsistent, KeepsSamplesOfALidarWithACommonRangeOffset) {
  // 20 mm along every ray: two centres at 70 degrees, more than this view has, differ by at most 2
  // * 20 mm * sin(35 deg) = 23 mm of the 60 mm that are allowed.
  for (const double offset_m : {0.02, -0.02}) {
    auto samples = Scene(40, 4);
    for (BoardSample& sample : samples) {
      const Eigen::Vector3d ray = sample.lidar.pose.centre_m.normalized();
      sample.lidar.pose.centre_m += offset_m * ray;
    }
    const Consistency found = FindConsistent(samples, {});
    EXPECT_EQ(found.consistent.size(), 36u);
    ASSERT_EQ(found.inconsistent.size(), 4u);
    EXPECT_EQ(found.inconsistent[3].sample, 3);
  }
}

TEST(FindConsistent, TakesTheRunnerUpThatFits) {
  // A second board stands still beside: in a third of the sweeps it is ranked first, in another
  // third second, in the rest it is not seen.
  auto samples = Scene(30, 0);
  LidarBoard other = samples[0].lidar;
  other.pose.centre_m += Eigen::Vector3d(0.5, 1.0, 0.0);
  for (std::size_t i = 0; i < 20; ++i) samples[i].runners_up = {other};
  std::vector<BoardSample> confused = samples;
  for (std::size_t i = 0; i < 10; ++i) TakeCandidate(1, &confused[i]);

  const Consistency found = FindConsistent(confused, {});
  EXPECT_EQ(found.consistent.size(), 30u);
  ASSERT_EQ(found.chosen.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(found.chosen[i].sample, static_cast<int>(i));
    EXPECT_EQ(found.chosen[i].candidate, 1);
    EXPECT_THAT(found.chosen[i].reason, HasSubstr("of 29 consistent samples"));
  }
  const std::vector<BoardSample> mended = ConsistentSamples(confused, found);
  ASSERT_EQ(mended.size(), samples.size());
  for (std::size_t i = 0; i < mended.size(); ++i) {
    EXPECT_EQ(mended[i].lidar.pose.centre_m, samples[i].lidar.pose.centre_m);
  }
}

TEST(FindConsistent, PrefersTheLikeliestCandidateWhereBothFit) {
  auto samples = Scene(10, 0);
  for (BoardSample& sample : samples) {
    sample.runners_up = {sample.lidar};
    sample.runners_up[0].pose.centre_m.x() += 0.005;
  }
  const Consistency found = FindConsistent(samples, {});
  EXPECT_EQ(found.consistent.size(), 10u);
  EXPECT_THAT(found.chosen, IsEmpty());
}

TEST(FindConsistent, DropsASampleOfWhichNoCandidateFits) {
  auto samples = Scene(12, 2);
  samples[0].runners_up = {samples[5].lidar, samples[6].lidar};
  const Consistency found = FindConsistent(samples, {});
  ASSERT_EQ(found.inconsistent.size(), 2u);
  EXPECT_EQ(found.inconsistent[0].sample, 0);
  EXPECT_THAT(found.chosen, IsEmpty());
}

TEST(TakeCandidate, RefusesOneThatIsNotThere) {
  auto samples = Scene(1, 0);
  EXPECT_THROW(TakeCandidate(1, &samples[0]), std::out_of_range);
  EXPECT_THROW(TakeCandidate(0, &samples[0]), std::out_of_range);
}

TEST(FindConsistent, CannotJudgeFewerThanThree) {
  EXPECT_THAT(FindConsistent(Scene(2, 1), {}).consistent, ElementsAre(0, 1));
  EXPECT_THAT(FindConsistent({}, {}).consistent, IsEmpty());
}

TEST(ConsistencyOptions, NamesEachProblem) {
  EXPECT_THAT(ConsistencyOptions{}.Problems(), IsEmpty());
  EXPECT_THAT((ConsistencyOptions{0.0, -0.1}.Problems()),
              ElementsAre("max_distance_m must be positive, is 0",
                          "max_angle_rad must be positive, is -0.1"));
  EXPECT_THROW(FindConsistent({}, {0.0, 0.1}), std::invalid_argument);
}

// The board was seen as a plane alone: its centre is off within the plane, and says so.
void SeePlaneAlone(double off_m, double sigma_m, LidarBoard* lidar) {
  const Eigen::Vector3d along = (lidar->pose.corners_m[1] - lidar->pose.corners_m[0]).normalized();
  lidar->sides.fill(SideView::kJoined);
  lidar->pose.centre_m += off_m * along;
  lidar->pose.covariance.setIdentity();
  lidar->pose.covariance *= 1e-4;
  const Eigen::Vector3d& n = lidar->pose.normal;
  lidar->pose.covariance.bottomRightCorner<3, 3>() +=
      sigma_m * sigma_m * (Eigen::Matrix3d::Identity() - n * n.transpose());
}

TEST(FindConsistent, GivesAnOpenSideItsUncertainty) {
  auto samples = Scene(10, 0);
  SeePlaneAlone(0.3, 0.2, &samples[4].lidar);
  EXPECT_THAT(FindConsistent(samples, {}).inconsistent, IsEmpty());
  samples[4].lidar.sides.fill(SideView::kMeasured);
  samples[4].lidar.pose.covariance.setZero();
  EXPECT_EQ(FindConsistent(samples, {}).inconsistent.size(), 1u);
}

TEST(FindConsistent, HoldsAPlaneAloneToItsPlane) {
  auto samples = Scene(10, 0);
  SeePlaneAlone(0.0, 0.2, &samples[4].lidar);
  samples[4].lidar.pose.centre_m += 1.2 * samples[4].lidar.pose.normal;
  const Consistency found = FindConsistent(samples, {});
  ASSERT_EQ(found.inconsistent.size(), 1u);
  EXPECT_EQ(found.inconsistent[0].sample, 4);
}

TEST(FindConsistent, GivesFewPixelsTheirUncertainty) {
  auto samples = Scene(10, 0);
  samples[4].camera.pose.centre_m *= 1.05;  // 5 % too far
  EXPECT_EQ(FindConsistent(samples, {}).inconsistent.size(), 1u);
  samples[4].camera.pose.covariance = 0.05 * 0.05 * Matrix6d::Identity();
  EXPECT_THAT(FindConsistent(samples, {}).inconsistent, IsEmpty());
}

}  // namespace
}  // namespace voqcal
