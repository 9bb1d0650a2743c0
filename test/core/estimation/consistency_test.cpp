#include "core/estimation/consistency.hpp"

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

}  // namespace
}  // namespace voqcal
