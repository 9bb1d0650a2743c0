#include "messaging/convert_result.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

const std::vector<std::int64_t> kIds = {3, 8, 11, 40};

Eigen::Isometry3d Transform(double angle_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3(angle_rad * Eigen::Vector3d(0.36, -0.48, 0.8));
  T.translation() = Eigen::Vector3d(0.1, -0.2, 1.0 / 3.0);
  return T;
}

VoqSet Set() {
  VoqSet set;
  set.samples = {0, 2, 3};
  set.kappa_lidar = 3.0 + 1.0 / 3.0;
  set.kappa_camera = 3.0 + 1.0 / 7.0;
  set.board_error_mm = 12.0 + 1.0 / 3.0;
  set.voq = set.kappa_lidar + set.board_error_mm;
  return set;
}

TEST(TransformMessage, ComesBackToRounding) {
  for (const double angle_rad : {0.0, 1e-9, 0.5, 1.7, 3.1, M_PI, 4.0, 6.2}) {
    const Eigen::Isometry3d T = Transform(angle_rad);
    const transform_t message = ToMessage(T);
    EXPECT_GE(message.quaternion_xyzw[3], 0.0);
    const Eigen::Isometry3d back = FromMessage(message);
    EXPECT_EQ(back.translation(), T.translation());
    // A few roundings of numbers below 1, each at most 1.1e-16.
    EXPECT_LT((back.linear() - T.linear()).norm(), 2e-15);
  }
}

TEST(TransformMessage, OrdersTheQuaternionXyzw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3(Eigen::Vector3d(0, 0, M_PI / 2));
  const transform_t message = ToMessage(T);
  EXPECT_NEAR(message.quaternion_xyzw[2], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(message.quaternion_xyzw[3], std::sqrt(0.5), 1e-15);
  const rigid_transform_t foreign = RigidTransformMessage(T, 12);
  EXPECT_EQ(foreign.utime, 12);
  EXPECT_NEAR(foreign.quat[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(foreign.quat[3], std::sqrt(0.5), 1e-15);
}

TEST(TransformMessage, IsRefusedIfItIsNoTransform) {
  EXPECT_THROW(FromMessage(transform_t{}), std::runtime_error);
  transform_t message = ToMessage(Transform(1.0));
  message.translation_m[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FromMessage(message), std::runtime_error);
  message = ToMessage(Transform(1.0));
  message.quaternion_xyzw[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FromMessage(message), std::runtime_error);
}

TEST(VoqSetMessage, ComesBackExactly) {
  const VoqSet set = Set();
  const voq_set_t message = ToMessage(set, kIds);
  EXPECT_EQ(message.sample_ids[1], 11);
  const VoqSet back = FromMessage(message, kIds);
  EXPECT_EQ(back.samples, set.samples);
  EXPECT_EQ(back.kappa_lidar, set.kappa_lidar);
  EXPECT_EQ(back.kappa_camera, set.kappa_camera);
  EXPECT_EQ(back.board_error_mm, set.board_error_mm);
  EXPECT_EQ(back.voq, set.voq);
}

TEST(VoqSetMessage, IsRefusedIfASampleIsUnknown) {
  EXPECT_THROW(FromMessage(ToMessage(Set(), kIds), {3, 8, 11}), std::runtime_error);
  EXPECT_THROW(ToMessage(Set(), {3, 8, 11}), std::out_of_range);
}

TEST(AveragedMessage, ComesBack) {
  AveragedExtrinsic average;
  average.T_camera_lidar = Transform(1.2);
  average.spread << 0.1, 0.2, 0.3, 0.4, 0.5, 1.0 / 3.0;
  average.is_kept = {true, false};
  average.reasons = {"", "not converged"};
  average.num_kept = 1;
  SetExtrinsic kept;
  kept.T_camera_lidar = Transform(1.1);
  kept.cost = 1.0 / 3.0;
  kept.status = SetStatus::kConverged;
  SetExtrinsic dropped = kept;
  dropped.status = SetStatus::kDegenerate;

  const voq_set_t set = ToMessage(Set(), kIds);
  const auto message = ToMessage(average, {set, set}, {kept, dropped});
  ASSERT_EQ(message.num_sets, 2);
  EXPECT_TRUE(message.sets[0].is_kept);
  EXPECT_FALSE(message.sets[1].is_kept);
  EXPECT_EQ(FromMessage(message.sets[0]).cost, kept.cost);
  EXPECT_EQ(FromMessage(message.sets[1]).status, SetStatus::kDegenerate);
  const AveragedExtrinsic back = FromMessage(message);
  EXPECT_EQ(back.spread, average.spread);
  EXPECT_EQ(back.is_kept, average.is_kept);
  EXPECT_EQ(back.reasons, average.reasons);
  EXPECT_EQ(back.num_kept, average.num_kept);
}

TEST(SetExtrinsicMessage, IsRefusedIfItsStatusIsUnknown) {
  set_extrinsic_t message = ToMessage(SetExtrinsic{}, ToMessage(Set(), kIds), true, "");
  message.status = "splendid";
  EXPECT_THROW(FromMessage(message), std::runtime_error);
}

TEST(RefinedMessage, ComesBack) {
  BestExtrinsic best;
  best.method = RefineMethod::kLikelihood;
  best.T_camera_lidar = Transform(0.3);
  for (int i = 0; i < 36; ++i) best.covariance(i / 6, i % 6) = 1.0 / (3.0 + i);
  best.covariance_given_rig = 0.1 * best.covariance;
  best.reprojection_rms_px = 1.0 / 3.0;
  best.held_out.poses.resize(kIds.size());
  best.held_out.poses[1] = {0.25, 0.5, 1.0, 2.0};
  best.trials = {{RefineMethod::kAverage, "none", {}}};
  best.likelihood.bias.common = {0.02, 0.001, true};
  best.likelihood.bias.rings = {{}, {-0.01, 0.002, true}};
  best.likelihood.bias.shades = {3.0, 40.0};
  best.chessboard_turn = {{0.01, -0.02}, {0.003, 0.004}};
  best.likelihood.noise = {0.05, 0.1, 0.2, 0.7, 0.4};
  best.likelihood.uncertainty.by_resampling << 1, 2, 3, 4, 5, 6;
  extrinsic_refined_t message = ToMessage(best, kIds);
  EXPECT_EQ(message.sample_ids, kIds);
  EXPECT_EQ(message.covariance[0][1], best.covariance(0, 1));
  const BestExtrinsic back = FromMessage(message);
  EXPECT_EQ(back.method, best.method);
  EXPECT_EQ(back.covariance, best.covariance);
  EXPECT_EQ(back.covariance_given_rig, best.covariance_given_rig);
  EXPECT_EQ(back.likelihood.uncertainty.covariance, best.covariance_given_rig);
  EXPECT_EQ(back.reprojection_rms_px, best.reprojection_rms_px);
  EXPECT_EQ(back.held_out.poses[1].corner_mm, 1.0);
  EXPECT_EQ(back.trials.at(0).problem, "none");
  EXPECT_EQ(back.Bias().common.value_m, 0.02);
  EXPECT_TRUE(back.Bias().rings.at(1).is_observable);
  EXPECT_FALSE(back.Bias().rings.at(0).is_observable);
  EXPECT_EQ(back.Bias().shades.bright_intensity, 40.0);
  EXPECT_EQ(back.chessboard_turn.value_rad, best.chessboard_turn.value_rad);
  EXPECT_EQ(back.chessboard_turn.standard_error_rad, best.chessboard_turn.standard_error_rad);
  EXPECT_EQ(back.likelihood.noise.range_m, 0.05);
  EXPECT_EQ(back.likelihood.noise.along_ray_m, 0.1);
  EXPECT_EQ(back.likelihood.noise.across_ray_m, 0.2);
  EXPECT_EQ(back.likelihood.noise.tilt_rad, 0.7);
  EXPECT_EQ(back.likelihood.noise.turn_rad, 0.4);
  EXPECT_EQ(back.likelihood.uncertainty.by_resampling, best.likelihood.uncertainty.by_resampling);
  EXPECT_TRUE(back.IsUsable());
  message.problem = "degenerate";
  EXPECT_FALSE(FromMessage(message).IsUsable());
  message.method = "splendid";
  EXPECT_THROW(FromMessage(message), std::runtime_error);
}

TEST(RefinedMessage, HasNoFaultsOfAMethodThatWasNotChosen) {
  BestExtrinsic best;
  best.method = RefineMethod::kReprojection;
  best.likelihood.bias.common = {0.02, 0.001, true};
  EXPECT_FALSE(FromMessage(ToMessage(best, {})).Bias().IsObservable());
}

TEST(SceneScoreMessage, ComesBackExactly) {
  SceneScore score;
  score.centre_px = {1.0 / 3.0, 0.2, 0.7};
  score.centre_mm = {3.0, 4.0, 5.0};
  score.corner_mm = {6.0, 7.0, 8.0};
  score.normal_deg = {0.1, 0.2, 0.3};
  const SceneScore back = FromMessage(ToMessage(score));
  EXPECT_EQ(back.centre_px.mean, score.centre_px.mean);
  EXPECT_EQ(back.centre_px.std, score.centre_px.std);
  EXPECT_EQ(back.centre_px.max, score.centre_px.max);
  EXPECT_EQ(back.centre_mm.mean, score.centre_mm.mean);
  EXPECT_EQ(back.corner_mm.max, score.corner_mm.max);
  EXPECT_EQ(back.normal_deg.std, score.normal_deg.std);
}

}  // namespace
}  // namespace voqcal
