#include "core/selection/pose_variety.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string ProblemOf(const test::SyntheticSamplesOptions& scene) {
  const auto samples = test::SynthesizeSamples(scene);
  return VarietyProblem(test::Pointers(samples));
}

TEST(VarietyProblem, IsNoneForBoardsAllOverTheView) { EXPECT_THAT(ProblemOf({}), IsEmpty()); }

TEST(VarietyProblem, NamesParallelBoards) {
  test::SyntheticSamplesOptions scene;
  scene.max_tilt_rad = 0.0;
  EXPECT_THAT(ProblemOf(scene), HasSubstr("all boards are parallel"));
}

TEST(VarietyProblem, NamesBoardsAtOnePlace) {
  test::SyntheticSamplesOptions scene;
  scene.spread = 0.0;
  EXPECT_THAT(ProblemOf(scene), HasSubstr("all boards are at one place"));
}

TEST(VarietyProblem, NamesBoardsOnOneLine) {
  auto samples = test::SynthesizeSamples({});
  double along_m = 0.0;
  for (BoardSample& sample : samples) {
    sample.camera.pose.centre_m =
        Eigen::Vector3d(0.2, -0.1, 2.0) + along_m * Eigen::Vector3d(1, 1, 2);
    along_m += 0.05;
  }
  EXPECT_THAT(VarietyProblem(test::Pointers(samples)), HasSubstr("all boards are on one line"));
}

TEST(VarietyProblem, NamesTooFewPoses) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 2;
  EXPECT_EQ(ProblemOf(scene), "only 2 poses: at least 3 are needed");
}

}  // namespace
}  // namespace voqcal
