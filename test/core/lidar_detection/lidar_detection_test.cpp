// The scenes of `voqcal_figures lidar-detection`.

#include "support/lidar_detection.hpp"

#include <gtest/gtest.h>

#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

class SightLidarBoards : public testing::TestWithParam<ScanPattern> {};

TEST_P(SightLidarBoards, GivesTheSameSeedTheSameBoardsAndVerdicts) {
  VOQCAL_LEAVE_TO_RELEASE();
  test::LidarDetectionOptions options;
  options.pattern = GetParam();
  options.num_sweeps = 3;
  const auto first = test::SightLidarBoards(options, {});
  const auto second = test::SightLidarBoards(options, {});
  ASSERT_EQ(first.size(), 3U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].Line(), second[i].Line());
    EXPECT_GT(first[i].hits.num_points, 0);
    EXPECT_GT(first[i].DistanceM(), options.min_distance_m);
    EXPECT_LT(first[i].DistanceM(), options.max_distance_m);
  }
  options.seed = 2;
  EXPECT_NE(test::SightLidarBoards(options, {})[0].Line(), first[0].Line());
}

INSTANTIATE_TEST_SUITE_P(EveryPattern,
                         SightLidarBoards,
                         testing::Values(ScanPattern::kVlp16,
                                         ScanPattern::kSpinning64,
                                         ScanPattern::kSpinning128,
                                         ScanPattern::kRaster,
                                         ScanPattern::kRosette),
                         [](const auto& test) { return ToString(test.param); });

}  // namespace
}  // namespace voqcal
