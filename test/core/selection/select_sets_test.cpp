#include "core/selection/select_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/estimation/set_extrinsic.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<BoardSample> Scene(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.edge_noise_m = 0.005;
  scene.lidar_rotation_noise_rad = 0.02;
  return test::SynthesizeSamples(scene);
}

std::vector<VoqSet> Select(const std::vector<BoardSample>& samples,
                           SelectionCriterion criterion,
                           int num_sets = 50,
                           std::uint32_t seed = 1) {
  SelectionOptions options;
  options.criterion = criterion;
  options.num_sets = num_sets;
  options.seed = seed;
  return SelectSets(samples, test::TestBoard(), test::TestCamera(), options);
}

std::vector<std::vector<int>> MembersOf(const std::vector<VoqSet>& sets) {
  std::vector<std::vector<int>> members;
  for (const VoqSet& set : sets) members.push_back(set.samples);
  return members;
}

// All combinations by the score, best first.
template <typename Score>
std::vector<std::vector<int>> BruteForce(int num_samples,
                                         std::size_t num_sets,
                                         const Score& score) {
  std::vector<std::pair<double, std::vector<int>>> all;
  for (int i = 0; i < num_samples; ++i) {
    for (int j = i + 1; j < num_samples; ++j) {
      for (int k = j + 1; k < num_samples; ++k) all.push_back({score(i, j, k), {i, j, k}});
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<std::vector<int>> best;
  for (std::size_t i = 0; i < std::min(num_sets, all.size()); ++i) best.push_back(all[i].second);
  return best;
}

Eigen::Matrix3d LidarNormals(const std::vector<BoardSample>& samples, int i, int j, int k) {
  Eigen::Matrix3d N;
  N << samples[i].lidar.pose.normal, samples[j].lidar.pose.normal, samples[k].lidar.pose.normal;
  return N;
}

Eigen::Matrix3d CameraNormals(const std::vector<BoardSample>& samples, int i, int j, int k) {
  Eigen::Matrix3d N;
  N << samples[i].camera.pose.normal, samples[j].camera.pose.normal, samples[k].camera.pose.normal;
  return N;
}

TEST(SelectSets, ChoosesByVoqUnlessToldOtherwise) {
  const auto samples = Scene(10);
  const auto sets = SelectSets(samples, test::TestBoard(), test::TestCamera(), {});
  EXPECT_EQ(MembersOf(sets), MembersOf(SelectByVoq(samples, test::TestBoard(), 50)));
}

TEST(SelectSets, FindsTheLowestConditionNumbers) {
  const auto samples = Scene(10);
  const auto kappa = [&](int i, int j, int k) {
    const Eigen::Matrix3d L = LidarNormals(samples, i, j, k);
    const Eigen::Matrix3d C = CameraNormals(samples, i, j, k);
    return std::max(L.norm() * L.inverse().norm(), C.norm() * C.inverse().norm());
  };
  const auto sets = Select(samples, SelectionCriterion::kConditionNumber, 20);
  EXPECT_EQ(MembersOf(sets), BruteForce(10, 20, kappa));
  EXPECT_NEAR(std::max(sets[0].kappa_lidar, sets[0].kappa_camera),
              kappa(sets[0].samples[0], sets[0].samples[1], sets[0].samples[2]),
              1e-9);
}

TEST(SelectSets, FindsTheLargestDeterminants) {
  const auto samples = Scene(10);
  const auto volume = [&](int i, int j, int k) {
    return -std::min(std::abs(LidarNormals(samples, i, j, k).determinant()),
                     std::abs(CameraNormals(samples, i, j, k).determinant()));
  };
  EXPECT_EQ(MembersOf(Select(samples, SelectionCriterion::kDeterminant, 20)),
            BruteForce(10, 20, volume));
}

TEST(SelectSets, FindsTheLowestPredictedErrors) {
  const auto samples = Scene(10);
  const SceneErrorPredictor predictor(
      samples, test::TestCamera(), AnalyticExtrinsic(test::Pointers(samples)), {});
  EXPECT_EQ(MembersOf(Select(samples, SelectionCriterion::kSceneError, 20)),
            BruteForce(10, 20, [&predictor](int i, int j, int k) {
              return predictor.PredictMm({i, j, k});
            }));
}

TEST(SelectSets, DrawsDifferentSetsByTheSeed) {
  const auto samples = Scene(10);
  const auto drawn = MembersOf(Select(samples, SelectionCriterion::kRandom, 40));
  EXPECT_THAT(drawn, SizeIs(40));
  EXPECT_THAT(std::set<std::vector<int>>(drawn.begin(), drawn.end()), SizeIs(40));
  EXPECT_EQ(drawn, MembersOf(Select(samples, SelectionCriterion::kRandom, 40)));
  EXPECT_NE(drawn, MembersOf(Select(samples, SelectionCriterion::kRandom, 40, 2)));
  EXPECT_THAT(Select(Scene(5), SelectionCriterion::kRandom, 50), SizeIs(10));  // all there are
}

TEST(SelectSets, DrawsEverySampleAboutEquallyOften) {
  std::vector<int> count(10, 0);
  constexpr int kRuns = 40;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    for (const VoqSet& set : Select(Scene(10), SelectionCriterion::kRandom, 30, seed)) {
      for (const int sample : set.samples) ++count[static_cast<std::size_t>(sample)];
    }
  }
  // Of 1200 sets a sample is in 3 of 10: 360, and by chance +- sqrt(1200 * 0.3 * 0.7) = 16; 4
  // sigma.
  for (const int each : count) EXPECT_NEAR(each, 360, 64);
}

TEST(SelectSets, MakesOneSetOfAllPoses) {
  const auto sets = Select(Scene(5), SelectionCriterion::kAllPoses);
  ASSERT_THAT(sets, SizeIs(1));
  EXPECT_THAT(sets[0].samples, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_GE(sets[0].kappa_lidar, 3.0);
}

TEST(SelectSets, TakesSightingsWithOpenSidesWhateverTheCriterion) {
  auto samples = Scene(6);
  samples[2].lidar.edge_lengths_m[0] = std::numeric_limits<double>::quiet_NaN();
  for (const SelectionCriterion criterion : AllSelectionCriteria()) {
    const auto sets = Select(samples, criterion);
    EXPECT_THAT(sets, SizeIs(criterion == SelectionCriterion::kAllPoses ? 1 : 20))
        << ToString(criterion);
    for (const VoqSet& set : sets) EXPECT_TRUE(std::isfinite(set.voq)) << ToString(criterion);
  }
}

TEST(SelectSets, FindsNothingInTwoSamples) {
  for (const SelectionCriterion criterion : AllSelectionCriteria()) {
    EXPECT_THAT(Select(Scene(2), criterion), IsEmpty()) << ToString(criterion);
    EXPECT_THAT(Select({}, criterion), IsEmpty()) << ToString(criterion);
  }
}

TEST(SelectionCriterion, IsReadByItsName) {
  for (const SelectionCriterion criterion : AllSelectionCriteria()) {
    EXPECT_EQ(SelectionCriterionFromString(ToString(criterion)), criterion);
  }
  EXPECT_FALSE(SelectionCriterionFromString("best"));
}

TEST(SelectionOptions, NamesEachProblem) {
  SelectionOptions options;
  EXPECT_THAT(options.Problems(), IsEmpty());
  options.num_sets = 0;
  options.nominal = {0.0, -0.1, -1.0};
  EXPECT_THAT(options.Problems(),
              ElementsAre("num_sets must be at least 1, is 0",
                          "rotation_rad must be positive, is 0",
                          "along_ray_m must be positive, is -0.1",
                          "across_px must be positive, is -1"));
  EXPECT_THROW(SelectSets({}, test::TestBoard(), test::TestCamera(), options),
               std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
