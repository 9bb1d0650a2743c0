#include "study/binned.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::SizeIs;

StudiedSet Set(double kappa, double error_mm, double shift_m) {
  StudiedSet set;
  set.kappa = kappa;
  set.mean_mm = set.held_out_mm = error_mm;
  set.deviation_mm = 0.5 * error_mm;
  set.extrinsic.T_camera_lidar = test::TestExtrinsic();
  set.extrinsic.T_camera_lidar.translation().x() += shift_m;
  return set;
}

TEST(BinSets, TakesMeansAndSpreadsOfEachBin) {
  const auto bins = BinSets({Set(9, 1, 0.0), Set(3, 2, 0.01), Set(5, 4, -0.01), Set(7, 3, 0.0)},
                            &StudiedSet::kappa,
                            100.0,
                            2);
  ASSERT_THAT(bins, SizeIs(2));
  EXPECT_EQ(bins[0].num_sets, 2);
  EXPECT_DOUBLE_EQ(bins[0].figure, 4.0);
  EXPECT_DOUBLE_EQ(bins[0].error_mm, 3.0);
  EXPECT_DOUBLE_EQ(bins[0].median_error_mm, 3.0);
  EXPECT_DOUBLE_EQ(bins[0].deviation_mm, 1.5);
  EXPECT_NEAR(bins[0].translation_spread_mm, 10.0 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(bins[0].rotation_spread_deg, 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(bins[1].figure, 8.0);
  EXPECT_NEAR(bins[1].translation_spread_mm, 0.0, 1e-9);
}

TEST(BinSets, LeavesOutWhatHasNoScoreOrTooLargeAKappa) {
  StudiedSet unscored = Set(4, 1, 0);
  unscored.held_out_mm = std::nan("");
  const auto bins =
      BinSets({Set(3, 1, 0), unscored, Set(21, 1, 0), Set(5, 1, 0)}, &StudiedSet::kappa, 20.0, 1);
  ASSERT_THAT(bins, SizeIs(1));
  EXPECT_EQ(bins[0].num_sets, 2);
}

}  // namespace
}  // namespace voqcal
