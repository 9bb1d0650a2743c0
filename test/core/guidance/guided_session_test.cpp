// The guidance followed through simulated sessions: `voqcal_figures guidance` in small.

#include "support/guided_session.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/median.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr int kNumSessions = 9;

std::vector<test::GuidedStep> LastSteps(bool is_guided, int num_poses) {
  std::vector<test::GuidedStep> last;
  for (std::uint32_t seed = 1; seed <= kNumSessions; ++seed) {
    test::GuidedSessionOptions options;
    options.simulation.T_camera_lidar = test::TestExtrinsic();
    options.simulation.common_bias_m = 0.02;
    options.simulation.seed = seed;
    options.is_guided = is_guided;
    options.num_poses = num_poses;
    options.seed = seed;
    GuidanceOptions guidance;
    guidance.limits.min_distance_m = 1.5;
    guidance.limits.max_distance_m = 4.5;
    last.push_back(
        test::SimulateGuidedSession(options, {test::TestBoard(), test::TestCamera(), {}}, guidance)
            .back());
  }
  return last;
}

double Median(const std::vector<test::GuidedStep>& steps, double test::GuidedStep::*error) {
  std::vector<double> errors;
  for (const test::GuidedStep& step : steps) errors.push_back(step.*error);
  return voqcal::Median(std::move(errors));
}

TEST(GuidedSession, EndsBetterThanARandomOneOfAsManyPoses) {
  VOQCAL_LEAVE_TO_RELEASE();
  constexpr int kNumPoses = 7;
  const std::vector<test::GuidedStep> guided = LastSteps(true, kNumPoses);
  const std::vector<test::GuidedStep> at_random = LastSteps(false, kNumPoses);
  for (const auto error : {&test::GuidedStep::predicted_error, &test::GuidedStep::true_error}) {
    EXPECT_LT(Median(guided, error), Median(at_random, error));
  }
}

TEST(PosesNeeded, CountsFromWhereAnErrorStaysWithinTheTolerance) {
  EXPECT_EQ(test::PosesNeeded({9, 4, 6, 5, 3}, 5.0), 4);
  EXPECT_EQ(test::PosesNeeded({9, 4, 6}, 5.0), 4);
  EXPECT_EQ(test::PosesNeeded({3, 2}, 5.0), 1);
}

}  // namespace
}  // namespace voqcal
