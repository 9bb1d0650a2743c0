#include "core/estimation/variance_components.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/estimation/pose_fit.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRotationSigmaRad = 0.002;
constexpr double kCentreSigmaM = 0.002;

// Boards as their covariances say, but for `errors`, which the camera's pose has beyond it.
std::vector<BoardSample> Session(int num_samples,
                                 const SightingErrors& errors,
                                 std::uint32_t seed) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = kRotationSigmaRad;
  scene.lidar_centre_noise_m = kCentreSigmaM;
  scene.seed = seed;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  test::Random random(seed + 1000);
  for (BoardSample& sample : samples) {
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(kRotationSigmaRad * kRotationSigmaRad),
        Eigen::Vector3d::Constant(kCentreSigmaM * kCentreSigmaM);
    sample.lidar.pose.covariance = variances.asDiagonal();
    BoardPose& pose = sample.camera.pose;
    const Eigen::Vector3d ray = pose.centre_m.normalized();
    const Eigen::Vector3d level = test::TestExtrinsic().linear().col(2).cross(ray).normalized();
    const Eigen::Vector3d chance = random.NormalVector();
    Vector6d error;
    error << errors.tilt_rad * (chance - chance.dot(pose.normal) * pose.normal) +
                 errors.turn_rad * random.Normal() * pose.normal,
        errors.level_m * random.Normal() * level +
            errors.upright_m * random.Normal() * ray.cross(level) +
            errors.along_ray_m * random.Normal() * ray;
    pose = PoseFromTransform(PerturbLeft(TransformFromPose(pose), error), test::TestBoard());
  }
  return samples;
}

MixedFit FitOf(const std::vector<BoardSample>& samples) {
  return FitWithErrors(test::Pointers(samples), test::TestCamera(), test::TestExtrinsic());
}

TEST(FitWithErrors, RecoversTheErrorsOfSightings) {
  const SightingErrors truth{0.025, 0.008, 0.004, 0.02, 0.006};
  const MixedFit mixed = FitOf(Session(80, truth, 1));
  ASSERT_TRUE(mixed.is_usable);
  // Of 80 independent values a deviation is known to 8 %, of twice as many to 6; allow 3 sigma.
  EXPECT_NEAR(mixed.errors.along_ray_m, truth.along_ray_m, 0.24 * truth.along_ray_m);
  EXPECT_NEAR(mixed.errors.level_m, truth.level_m, 0.24 * truth.level_m);
  EXPECT_NEAR(mixed.errors.upright_m, truth.upright_m, 0.24 * truth.upright_m);
  EXPECT_NEAR(mixed.errors.tilt_rad, truth.tilt_rad, 0.18 * truth.tilt_rad);
  EXPECT_NEAR(mixed.errors.turn_rad, truth.turn_rad, 0.24 * truth.turn_rad);
}

TEST(FitWithErrors, FindsLittleWhereCovariancesAreHonest) {
  const MixedFit mixed = FitOf(Session(80, {}, 1));
  ASSERT_TRUE(mixed.is_usable);
  // What a prior of one observation, ten times the noise along the ray, leaves among 80.
  EXPECT_LT(mixed.errors.along_ray_m, 2.0 * kCentreSigmaM);
  EXPECT_LT(mixed.errors.level_m, 1.0 * kCentreSigmaM);
  EXPECT_LT(mixed.errors.upright_m, 1.0 * kCentreSigmaM);
  EXPECT_LT(mixed.errors.tilt_rad, 2.0 * kRotationSigmaRad);
  EXPECT_LT(mixed.errors.turn_rad, 1.0 * kRotationSigmaRad);
}

TEST(FitWithErrors, DoesNotTakeTheExtrinsicsUnknownsForAgreement) {
  // Four boards, whose six unknowns bend to them: restricted likelihood allows for that.
  const SightingErrors truth{0.02, 0.005, 0.005, 0.02, 0.005};
  constexpr int kRuns = 40;
  double sum_squares = 0.0;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    const MixedFit mixed = FitOf(Session(4, truth, seed));
    ASSERT_TRUE(mixed.is_usable);
    sum_squares += mixed.errors.tilt_rad * mixed.errors.tilt_rad / kRuns;
  }
  // Without the allowance three of eight degrees of freedom are lost: 0.79.
  EXPECT_NEAR(std::sqrt(sum_squares) / truth.tilt_rad, 1.0, 0.15);
}

TEST(FitWithErrors, WeighsSightingsByTheirErrors) {
  const SightingErrors truth{
      0.03, 0.001, 0.001, 0.001, 0.001};  // along the ray the centre says little
  double sum_plain_m2 = 0.0;
  double sum_mixed_m2 = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const auto samples = Session(20, truth, seed);
    const auto error_m2 = [](const Eigen::Isometry3d& T_camera_lidar) {
      return DifferenceLeft(test::TestExtrinsic(), T_camera_lidar).tail<3>().squaredNorm();
    };
    sum_plain_m2 +=
        error_m2(FitPoses(test::Pointers(samples), test::TestCamera(), test::TestExtrinsic(), {})
                     .T_camera_lidar);
    sum_mixed_m2 += error_m2(FitOf(samples).T_camera_lidar);
  }
  EXPECT_LT(sum_mixed_m2, sum_plain_m2);
}

TEST(FitWithErrors, TellsTheChessboardsTurnFromTheExtrinsics) {
  const Eigen::Vector2d turn_rad(0.012, -0.008);
  std::vector<BoardSample> samples = Session(40, {0.002, 0.002, 0.002, 0.005, 0.003}, 1);
  for (BoardSample& sample : samples) {
    Vector6d turn = Vector6d::Zero();
    turn.head<2>() = turn_rad;
    BoardPose& pose = sample.camera.pose;
    pose = PoseFromTransform(PerturbLeft(TransformFromPose(pose), turn), test::TestBoard());
  }
  const MixedFit mixed = FitOf(samples);
  ASSERT_TRUE(mixed.is_usable);
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), mixed.T_camera_lidar);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(error[i]), 3 * std::sqrt(mixed.covariance(i, i))) << i;
  }
  EXPECT_LT(error.head<3>().norm(), 0.2 * turn_rad.norm());
  EXPECT_NEAR(mixed.shared.chessboard_turn_x_rad, turn_rad.x(), 0.2 * turn_rad.norm());
  EXPECT_NEAR(mixed.shared.chessboard_turn_y_rad, turn_rad.y(), 0.2 * turn_rad.norm());
}

TEST(FitWithErrors, LetsTheTurnFollowAGivenExtrinsic) {
  const MixedFit mixed = FitOf(Session(20, {0.002, 0.002, 0.002, 0.005, 0.003}, 1));
  ASSERT_TRUE(mixed.is_usable);
  EXPECT_EQ(mixed.SharedAt(mixed.T_camera_lidar).chessboard_turn_x_rad,
            mixed.shared.chessboard_turn_x_rad);
  Vector6d step = Vector6d::Zero();
  step[0] = 0.01;  // the lidar's normals turn, and the chessboards' stay: they differ by the less
  const double moved =
      mixed.SharedAt(PerturbLeft(mixed.T_camera_lidar, step)).chessboard_turn_x_rad -
      mixed.shared.chessboard_turn_x_rad;
  EXPECT_NEAR(moved, -0.01, 0.002);
}

TEST(FitWithErrors, IsNotUsableWhereTheExtrinsicIsOpen) {
  EXPECT_FALSE(FitWithErrors({}, test::TestCamera(), test::TestExtrinsic()).is_usable);
}

TEST(SightingErrors, WidenAlongTheRayAcrossItAndAboutTheNormal) {
  BoardPose pose;
  pose.centre_m = {0, 0, 2};
  pose.normal = {0, 0, -1};
  Eigen::Matrix3d R_camera_lidar;  // lidar x forward, z up: level is the camera's x
  R_camera_lidar << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  Vector6d expected;
  expected << 16, 16, 25, 4, 9, 1;
  const Matrix6d covariance = SightingErrors{1, 2, 3, 4, 5}.CovarianceOf(pose, R_camera_lidar);
  EXPECT_TRUE(covariance.diagonal().isApprox(expected));
}

TEST(SightingErrors, AreAllCountedWhereTheRayIsTheLidarsAxis) {
  BoardPose pose;
  pose.centre_m = {0, 0, 2};
  pose.normal = {0, 0, -1};
  const Matrix6d covariance =
      SightingErrors{1, 2, 2, 4, 5}.CovarianceOf(pose, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(covariance.trace(), 4 + 4 + 1 + 16 + 16 + 25, 1e-9);
}

}  // namespace
}  // namespace voqcal
