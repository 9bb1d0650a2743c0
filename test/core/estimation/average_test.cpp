#include "core/estimation/average.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

SetExtrinsic Usable(const Eigen::Isometry3d& T_camera_lidar) {
  SetExtrinsic set;
  set.T_camera_lidar = T_camera_lidar;
  set.status = SetStatus::kConverged;
  return set;
}

SetExtrinsic Perturbed(const Vector6d& delta) {
  return Usable(PerturbLeft(test::TestExtrinsic(), delta));
}

Vector6d Along(int parameter, double by) {
  Vector6d delta = Vector6d::Zero();
  delta[parameter] = by;
  return delta;
}

TEST(AverageExtrinsics, IsTheResultOfEqualSets) {
  const std::vector<SetExtrinsic> sets(5, Usable(test::TestExtrinsic()));
  const AveragedExtrinsic average = AverageExtrinsics(sets, {});
  EXPECT_THAT(average.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-12, 1e-12));
  EXPECT_THAT(average.is_kept, Each(true));
  EXPECT_EQ(average.num_kept, 5);
  EXPECT_LT(average.spread.norm(), 1e-12);
}

TEST(AverageExtrinsics, HasTheMeanAndSpreadOfEachParameter) {
  // Two sets one unit to either side: mean zero, deviation (n - 1) sqrt(2) units.
  for (int parameter = 0; parameter < 6; ++parameter) {
    const AveragedExtrinsic average = AverageExtrinsics(
        {Perturbed(Along(parameter, 0.01)), Perturbed(Along(parameter, -0.01))}, {});
    EXPECT_THAT(average.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-12, 1e-12));
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(average.spread[i], i == parameter ? 0.01 * std::sqrt(2.0) : 0.0, 1e-9);
    }
  }
}

TEST(AverageExtrinsics, DropsWhatIsTwoDeviationsOffInAnyParameter) {
  // Nine at -d and one at 9 d: mean 0, deviation 3.16 d, so the one is 2.85 deviations off.
  for (int parameter = 0; parameter < 6; ++parameter) {
    std::vector<SetExtrinsic> sets(9, Perturbed(Along(parameter, -0.001)));
    sets.push_back(Perturbed(Along(parameter, 0.009)));
    const AveragedExtrinsic average = AverageExtrinsics(sets, {});
    EXPECT_EQ(average.num_kept, 9);
    EXPECT_FALSE(average.is_kept[9]);
    EXPECT_EQ(average.reasons[0], "");
    constexpr const char* kNames[6] = {"rotation x",
                                       "rotation y",
                                       "rotation z",
                                       "translation x",
                                       "translation y",
                                       "translation z"};
    EXPECT_EQ(
        average.reasons[9],
        std::string(kNames[parameter]) + " is 2.85 standard deviations from the mean of all sets");
    EXPECT_THAT(average.T_camera_lidar, test::IsNear(sets[0].T_camera_lidar, 1e-12, 1e-12));
    EXPECT_EQ(AverageExtrinsics(sets, {2.9}).num_kept, 10);
  }
}

TEST(AverageExtrinsics, FiltersOnce) {
  // Without 1.0, 0.1 would be an outlier of the rest too: one pass keeps it.
  std::vector<SetExtrinsic> sets(9, Perturbed(Along(3, 0.0)));
  sets.push_back(Perturbed(Along(3, 0.1)));
  sets.push_back(Perturbed(Along(3, 1.0)));
  const AveragedExtrinsic average = AverageExtrinsics(sets, {});
  EXPECT_TRUE(average.is_kept[9]);
  EXPECT_FALSE(average.is_kept[10]);
}

TEST(AverageExtrinsics, LeavesOutUnusableSets) {
  SetExtrinsic degenerate = Perturbed(Along(4, 5.0));
  degenerate.status = SetStatus::kDegenerate;
  const AveragedExtrinsic average =
      AverageExtrinsics({Usable(test::TestExtrinsic()), degenerate}, {});
  EXPECT_THAT(average.is_kept, ElementsAre(true, false));
  EXPECT_THAT(average.reasons, ElementsAre("", "degenerate"));
  EXPECT_THAT(average.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-12, 1e-12));
  EXPECT_TRUE(std::isnan(average.spread[0])) << "one set shows no spread";
}

TEST(AverageExtrinsics, IsNotUsableWithoutSets) {
  EXPECT_FALSE(AverageExtrinsics({}, {}).IsUsable());
  EXPECT_FALSE(AverageExtrinsics({SetExtrinsic{}}, {}).IsUsable());
}

TEST(AverageOptions, NamesEachProblem) {
  EXPECT_THAT(AverageOptions{}.Problems(), IsEmpty());
  EXPECT_THAT(AverageOptions{-1.0}.Problems(), ElementsAre("max_z_score must be positive, is -1"));
  EXPECT_THROW(AverageExtrinsics({}, {0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
