#include "messaging/convert_assessment.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(ToMessage, OfASceneCheckCarriesVerdictTurnAndProbes) {
  SceneCheck check;
  check.verdict = Agreement::kDisagrees;
  check.reason = "its edges fit best elsewhere";
  check.num_edges = 700;
  check.score = 0.7;
  check.asked << 0.1, 0.2, 0.3, 1, 2, 3;
  check.sigma << 0.01, 0.02, 0.03, 0.1, 0.2, 0.3;
  check.axes[1] = Agreement::kDisagrees;
  SceneProbe probe;
  probe.delta[4] = 0.5;
  probe.score = 0.6;
  check.probes = {SceneProbe{}, probe};
  const scene_check_t message = ToMessage(check);
  EXPECT_EQ(message.verdict, "disagrees");
  EXPECT_EQ(message.reason, check.reason);
  EXPECT_EQ(message.num_edges, 700);
  EXPECT_EQ(message.score, 0.7);
  EXPECT_EQ(message.asked[1], 0.2);
  EXPECT_EQ(message.sigma[5], 0.3);
  EXPECT_EQ(message.axes[0], "cannot tell");
  EXPECT_EQ(message.axes[1], "disagrees");
  ASSERT_EQ(message.num_probes, 2);
  EXPECT_EQ(message.probes[1].delta[4], 0.5);
  EXPECT_EQ(message.probes[1].score, 0.6);
}

TEST(ToMessage, OfAFindingCarriesItsEvidence) {
  Finding finding;
  finding.cause = "focal length";
  finding.text = "too long";
  finding.is_dealt_with = true;
  finding.value = -2;
  finding.standard_error = 0.1;
  finding.unit = "%";
  finding.log_likelihood_gain = 30;
  finding.explained = 0.5;
  finding.held_out_before_mm = 9;
  finding.held_out_after_mm = 2;
  const finding_t message = ToMessage(finding);
  EXPECT_EQ(message.cause, "focal length");
  EXPECT_EQ(message.text, "too long");
  EXPECT_EQ(message.is_dealt_with, 1);
  EXPECT_EQ(message.value, -2);
  EXPECT_EQ(message.standard_error, 0.1);
  EXPECT_EQ(message.unit, "%");
  EXPECT_EQ(message.log_likelihood_gain, 30);
  EXPECT_EQ(message.explained, 0.5);
  EXPECT_EQ(message.held_out_before_mm, 9);
  EXPECT_EQ(message.held_out_after_mm, 2);
}

TEST(ToMessage, OfABinAndAPredictedError) {
  ScoreBin bin{"2 to 3 m", {}};
  bin.score.poses.resize(4);
  bin.score.centre_mm.mean = 3;
  EXPECT_EQ(ToMessage(bin).name, "2 to 3 m");
  EXPECT_EQ(ToMessage(bin).num_samples, 4);
  EXPECT_EQ(ToMessage(bin).score.centre_mm.mean, 3);
  const predicted_error_t error = ToMessage(PredictedError{10, 1, 2, 3, 4});
  EXPECT_EQ(error.range_m, 10);
  EXPECT_EQ(error.centre_px, 1);
  EXPECT_EQ(error.centre_mm, 2);
  EXPECT_EQ(error.corner_px, 3);
  EXPECT_EQ(error.corner_mm, 4);
}

}  // namespace
}  // namespace voqcal
