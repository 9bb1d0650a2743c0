#include "core/estimation/set_extrinsic.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/estimation/set_cost.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<BoardSample> Scene(int num_samples, double noise_scale, std::uint32_t seed = 1) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_centre_noise_m = 0.01 * noise_scale;
  scene.lidar_rotation_noise_rad = 0.01 * noise_scale;
  scene.seed = seed;
  return test::SynthesizeSamples(scene);
}

SetExtrinsic Estimate(const std::vector<BoardSample>& samples) {
  return EstimateSetExtrinsic(test::Pointers(samples), test::TestCamera(), {});
}

// Horn 1987: the best rotation is the eigenvector of largest eigenvalue of a 4x4 matrix of
// quaternions.
Eigen::Matrix3d HornRotation(const std::vector<BoardSample>& samples) {
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (const auto& s : samples) S += s.lidar.pose.normal * s.camera.pose.normal.transpose();
  Eigen::Matrix4d N;                                                        // order w x y z
  N << S.trace(), S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0),  //
      S(1, 2) - S(2, 1), S(0, 0) - S(1, 1) - S(2, 2), S(0, 1) + S(1, 0), S(2, 0) + S(0, 2),
      S(2, 0) - S(0, 2), S(0, 1) + S(1, 0), S(1, 1) - S(0, 0) - S(2, 2), S(1, 2) + S(2, 1),
      S(0, 1) - S(1, 0), S(2, 0) + S(0, 2), S(1, 2) + S(2, 1), S(2, 2) - S(0, 0) - S(1, 1);
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(N).eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

TEST(AnalyticExtrinsic, IsTheTruthOnCleanData) {
  const auto samples = Scene(3, 0.0);
  EXPECT_THAT(AnalyticExtrinsic(test::Pointers(samples)),
              test::IsNear(test::TestExtrinsic(), 1e-9, 1e-9));
}

TEST(AnalyticExtrinsic, AgreesWithHorn) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const auto samples = Scene(3, 3.0, seed);
    const Eigen::Isometry3d T = AnalyticExtrinsic(test::Pointers(samples));
    EXPECT_LT(RotationAngleBetween(T.linear(), HornRotation(samples)), 1e-7);
    EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(SetCost, JacobianAgreesWithDifferences) {
  const auto samples = Scene(4, 1.0);
  const CameraModel camera = test::TestCamera();
  const SetExtrinsicOptions options;
  const Eigen::Isometry3d T_start = test::TestExtrinsic();
  const auto poses =
      SetPosesOf(test::Pointers(samples), camera, test::TestExtrinsic().linear(), options);
  const SetCost cost{poses, camera, T_start, options};
  Vector6d delta;
  delta << 0.2, -0.1, 0.15, 0.1, 0.05, -0.2;  // away from zero, where the chart's Jacobian matters
  Eigen::VectorXd r(cost.NumResiduals()), r_plus(r.size()), r_minus(r.size());
  Eigen::MatrixXd J(r.size(), 6);
  ASSERT_TRUE(cost(delta.data(), r.data(), J.data()));
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    const Vector6d plus = delta + step;
    const Vector6d minus = delta - step;
    ASSERT_TRUE(cost(plus.data(), r_plus.data(), nullptr));
    ASSERT_TRUE(cost(minus.data(), r_minus.data(), nullptr));
    const Eigen::VectorXd numeric = (r_plus - r_minus) / (2 * kStep);
    // Central differences: third derivative * step^2 and rounding / step, relative to entries ~
    // 500.
    EXPECT_LT((J.col(i) - numeric).lpNorm<Eigen::Infinity>(), 1e-6 * (1.0 + numeric.norm())) << i;
  }
}

TEST(SetCost, FailsWhereTheLensShowsNothing) {
  const auto samples = Scene(3, 0.0);
  CameraModel camera = test::TestCamera();
  camera.lens = LensModel::kPlumbBob;
  camera.distortion = {0, 0, 0, 0, 0};
  const SetExtrinsicOptions options;
  const Eigen::Isometry3d T_start = test::TestExtrinsic();
  const auto poses =
      SetPosesOf(test::Pointers(samples), camera, test::TestExtrinsic().linear(), options);
  const SetCost cost{poses, camera, T_start, options};
  Vector6d delta = Vector6d::Zero();
  delta[5] = -10.0;
  Eigen::VectorXd r(cost.NumResiduals());
  EXPECT_FALSE(cost(delta.data(), r.data(), nullptr));
  EXPECT_GT(r.norm(), 1e9) << "so that TinySolver rejects the step";
}

TEST(EstimateSetExtrinsic, IsTheTruthOnCleanData) {
  for (const int num_samples : {3, 9}) {
    const SetExtrinsic set = Estimate(Scene(num_samples, 0.0));
    EXPECT_EQ(set.status, SetStatus::kConverged);
    EXPECT_THAT(set.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-9, 1e-9));
    EXPECT_LT(set.cost, 1e-12);
  }
}

TEST(EstimateSetExtrinsic, IsAMinimum) {
  const auto samples = Scene(3, 1.0);
  const SetExtrinsic set = Estimate(samples);
  ASSERT_TRUE(set.IsUsable());
  const CameraModel camera = test::TestCamera();
  const SetExtrinsicOptions options;
  const auto poses =
      SetPosesOf(test::Pointers(samples), camera, test::TestExtrinsic().linear(), options);
  const SetCost cost{poses, camera, set.T_camera_lidar, options};
  Eigen::VectorXd r(cost.NumResiduals());
  for (int i = 0; i < 12; ++i) {
    const Vector6d delta = (i % 2 == 0 ? 1e-4 : -1e-4) * Vector6d::Unit(i / 2);
    ASSERT_TRUE(cost(delta.data(), r.data(), nullptr));
    EXPECT_GT(0.5 * r.squaredNorm(), set.cost) << i;
  }
}

TEST(EstimateSetExtrinsic, ErrorScalesWithNoise) {
  const auto error_at = [](double noise_scale) {
    const SetExtrinsic set = Estimate(Scene(3, noise_scale));
    return DifferenceLeft(test::TestExtrinsic(), set.T_camera_lidar).norm();
  };
  // The same draws, scaled: linear to first order.
  EXPECT_NEAR(error_at(0.2) / error_at(0.1), 2.0, 0.2);
  EXPECT_NEAR(error_at(0.02) / error_at(0.01), 2.0, 0.02);
}

TEST(EstimateSetExtrinsic, IsDegenerateForParallelNormals) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 3;
  scene.max_tilt_rad = 0.0;
  EXPECT_EQ(Estimate(test::SynthesizeSamples(scene)).status, SetStatus::kDegenerate);
  scene.lidar_rotation_noise_rad = 0.01;  // noise must not pass for variety
  EXPECT_EQ(Estimate(test::SynthesizeSamples(scene)).status, SetStatus::kDegenerate);
}

TEST(EstimateSetExtrinsic, NeedsThreeFinitePoses) {
  EXPECT_EQ(Estimate(Scene(2, 0.0)).status, SetStatus::kDegenerate);
  EXPECT_EQ(Estimate({}).status, SetStatus::kDegenerate);
  auto samples = Scene(3, 0.0);
  samples[1].lidar.pose.normal.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Estimate(samples).status, SetStatus::kDegenerate);
}

TEST(EstimateSetExtrinsic, DoesNotNeedSpreadCentres) {
  // One place: the normals fix the rotation, the centres the translation.
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 3;
  scene.spread = 0.0;
  const SetExtrinsic set = Estimate(test::SynthesizeSamples(scene));
  EXPECT_EQ(set.status, SetStatus::kConverged);
  EXPECT_THAT(set.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-9, 1e-9));
}

TEST(EstimateSetExtrinsic, SaysWhenIterationsRunOut) {
  SetExtrinsicOptions options;
  options.max_iterations = 1;
  const auto samples = Scene(3, 3.0);
  EXPECT_EQ(EstimateSetExtrinsic(test::Pointers(samples), test::TestCamera(), options).status,
            SetStatus::kNotConverged);
}

TEST(SetExtrinsicOptions, NamesEachProblem) {
  EXPECT_THAT(SetExtrinsicOptions{}.Problems(), IsEmpty());
  SetExtrinsicOptions options;
  options.sigma_normal_rad = 0.0;
  options.sigma_centre_px = -2.0;
  options.max_iterations = 0;
  EXPECT_THAT(options.Problems(),
              ElementsAre("sigma_normal_rad must be positive, is 0",
                          "sigma_centre_px must be positive, is -2",
                          "max_iterations must be positive, is 0"));
  EXPECT_THROW(EstimateSetExtrinsic({}, test::TestCamera(), options), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
