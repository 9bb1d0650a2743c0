#include "study/all_sets.hpp"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/assessment/scores.hpp"
#include "core/selection/voq.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::SizeIs;

std::vector<BoardSample> Scene(int num_samples, double noise) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = noise;
  scene.lidar_centre_noise_m = noise;
  scene.edge_noise_m = noise;
  return test::SynthesizeSamples(scene);
}

std::vector<StudiedSet> Study(const std::vector<BoardSample>& samples) {
  return StudyAllSets(samples, test::TestBoard(), test::TestCamera(), {});
}

TEST(StudyAllSets, CoversEveryCombinationInOrder) {
  const auto sets = Study(Scene(7, 0.005));
  EXPECT_THAT(sets, SizeIs(35));
  EXPECT_TRUE(std::is_sorted(sets.begin(), sets.end(), [](const auto& a, const auto& b) {
    return a.samples < b.samples;
  }));
}

TEST(StudyAllSets, AgreesWithVoqAndScores) {
  const auto samples = Scene(8, 0.005);
  for (const StudiedSet& set : Study(samples)) {
    const VoqSet voq =
        ScoreVoq(samples, {set.samples.begin(), set.samples.end()}, test::TestBoard());
    EXPECT_DOUBLE_EQ(set.voq, voq.voq);
    EXPECT_DOUBLE_EQ(set.kappa, std::max(voq.kappa_lidar, voq.kappa_camera));
    ASSERT_TRUE(set.IsScored());
    const SceneScore scene =
        ScoreScene(test::Pointers(samples), test::TestCamera(), set.extrinsic.T_camera_lidar);
    EXPECT_NEAR(set.mean_px, scene.centre_px.mean, 1e-9);
    EXPECT_NEAR(set.mean_mm, scene.centre_mm.mean, 1e-9);
    EXPECT_NEAR(set.deviation_mm, scene.centre_mm.std, 1e-9);
    std::vector<const BoardSample*> others;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const bool is_own =
          std::count(set.samples.begin(), set.samples.end(), static_cast<int>(i)) > 0;
      if (!is_own) others.push_back(&samples[i]);
    }
    EXPECT_NEAR(set.held_out_mm,
                ScoreScene(others, test::TestCamera(), set.extrinsic.T_camera_lidar).centre_mm.mean,
                1e-9);
  }
}

TEST(StudyAllSets, FindsNoErrorInExactSamples) {
  for (const StudiedSet& set : Study(Scene(6, 0.0))) {
    EXPECT_THAT(set.extrinsic.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-6, 1e-6));
    EXPECT_LT(set.held_out_mm, 1e-3);  // what the solver leaves
  }
}

TEST(StudyAllSets, KeepsSamplesWithAnOpenEdge) {
  auto samples = Scene(5, 0.005);
  samples[2].lidar.edge_lengths_m[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Study(samples), SizeIs(10));
}

TEST(SceneCentres, HasNoErrorForACentreBehindTheCamera) {
  const auto samples = Scene(3, 0.0);
  const SceneCentres scene(samples, test::TestCamera());
  Eigen::Isometry3d T_behind = test::TestExtrinsic();
  T_behind.translation().z() -= 100.0;
  EXPECT_NEAR(scene.ErrorPx(0, test::TestExtrinsic()), 0.0, 1e-9);
  EXPECT_TRUE(std::isnan(scene.ErrorPx(0, T_behind)));
}

}  // namespace
}  // namespace voqcal
