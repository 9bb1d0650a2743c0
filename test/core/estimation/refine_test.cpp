#include "core/estimation/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/board/half_turn.hpp"
#include "core/estimation/refine_terms.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

test::SyntheticSamplesOptions Noisy(double noise_scale, std::uint32_t seed = 1) {
  test::SyntheticSamplesOptions scene;
  scene.lidar_centre_noise_m = 0.005 * noise_scale;
  scene.lidar_rotation_noise_rad = 0.01 * noise_scale;
  scene.seed = seed;
  return scene;
}

Eigen::Isometry3d RoughStart() {
  Vector6d delta;
  delta << 0.02, -0.03, 0.02, 0.03, -0.04, 0.05;
  return PerturbLeft(test::TestExtrinsic(), delta);
}

RefinedExtrinsic Refine(const std::vector<BoardSample>& samples,
                        const RefineOptions& options = {}) {
  return RefineExtrinsic(test::Pointers(samples), test::TestCamera(), RoughStart(), options);
}

TEST(LidarPoseInCameraOrder, UndoesAHalfTurn) {
  auto sample = test::SynthesizeSamples({}).front();
  const auto corners_m = sample.lidar.pose.corners_m;
  EXPECT_EQ(LidarPoseInCameraOrder(sample, RoughStart()).corners_m, corners_m);
  sample.lidar.pose = TurnedByHalf(sample.lidar.pose);
  EXPECT_EQ(LidarPoseInCameraOrder(sample, RoughStart()).corners_m, corners_m);
}

TEST(PointReprojectionCost, JacobianAgreesWithDifferences) {
  const Eigen::Matrix2d trust = (Eigen::Matrix2d() << 0.9, 0.1, 0.1, 0.4).finished();
  const PointReprojectionCost cost(
      test::TestCamera(), RoughStart(), {2.0, 0.4, -0.3}, {900, 700}, trust);
  Vector6d delta;
  delta << 0.3, -0.2, 0.1, 0.05, -0.1, 0.2;
  const double* parameters = delta.data();
  Eigen::Vector2d r;
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> J;
  double* jacobian = J.data();
  ASSERT_TRUE(cost.Evaluate(&parameters, r.data(), &jacobian));
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d plus = delta + kStep * Vector6d::Unit(i);
    const Vector6d minus = delta - kStep * Vector6d::Unit(i);
    const double* at_plus = plus.data();
    const double* at_minus = minus.data();
    Eigen::Vector2d r_plus, r_minus;
    ASSERT_TRUE(cost.Evaluate(&at_plus, r_plus.data(), nullptr));
    ASSERT_TRUE(cost.Evaluate(&at_minus, r_minus.data(), nullptr));
    // Pixels have 13 digits left of 1e3: rounding 1e-13 / 1e-6, and entries of about 1e3.
    EXPECT_LT((J.col(i) - (r_plus - r_minus) / (2 * kStep)).norm(), 1e-5) << i;
  }
}

TEST(PointReprojectionCost, FailsWhereTheLensShowsNothing) {
  CameraModel camera = test::TestCamera();
  camera.lens = LensModel::kPlumbBob;
  camera.distortion = {0, 0, 0, 0, 0};
  const PointReprojectionCost cost(
      camera, RoughStart(), {-2.0, 0.4, -0.3}, {900, 700}, Eigen::Matrix2d::Identity());
  const Vector6d delta = Vector6d::Zero();
  const double* parameters = delta.data();
  Eigen::Vector2d r;
  EXPECT_FALSE(cost.Evaluate(&parameters, r.data(), nullptr));
}

TEST(RefineExtrinsic, IsTheTruthOnCleanData) {
  for (const int num_samples : {3, 30}) {
    test::SyntheticSamplesOptions scene;
    scene.num_samples = num_samples;
    const RefinedExtrinsic refined = Refine(test::SynthesizeSamples(scene));
    EXPECT_EQ(refined.status, RefineStatus::kConverged);
    EXPECT_THAT(refined.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-9, 1e-9));
    EXPECT_LT(refined.reprojection_rms_px, 1e-6);
  }
}

TEST(RefineExtrinsic, DoesNotMindHalfTurnedPoses) {
  auto scene = Noisy(1.0);
  const auto straight = Refine(test::SynthesizeSamples(scene));
  scene.num_half_turned = 11;
  const auto turned = Refine(test::SynthesizeSamples(scene));
  EXPECT_THAT(turned.T_camera_lidar, test::IsNear(straight.T_camera_lidar, 1e-9, 1e-9));
}

TEST(RefineExtrinsic, ErrorScalesWithNoise) {
  const auto error_at = [](double noise_scale) {
    const auto refined = Refine(test::SynthesizeSamples(Noisy(noise_scale)));
    return DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar).norm();
  };
  // The same draws, scaled, within the Huber width: linear to first order.
  EXPECT_NEAR(error_at(0.02) / error_at(0.01), 2.0, 0.02);
  EXPECT_NEAR(error_at(0.2) / error_at(0.1), 2.0, 0.2);
}

TEST(RefineExtrinsic, BoundsWhatOneWrongPoseDoes) {
  auto samples = test::SynthesizeSamples({});
  samples[0].lidar.pose.centre_m.y() += 0.10;  // 60 px, 20 Huber widths
  const auto error = [](const RefinedExtrinsic& refined) {
    return DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar).norm();
  };
  RefineOptions plain;
  plain.huber_px = 1e6;
  // Ten times less than without Huber's loss: its pull is that of 3 px, not of 60.
  EXPECT_LT(error(Refine(samples)), 0.1 * error(Refine(samples, plain)));
}

TEST(RefineExtrinsic, CovarianceIsTheSpreadOfManyTrials) {
  // Below the Huber width, so that the estimate is linear; 200 trials know a deviation to 5 %. Few
  // poses have leverage that can only be partly corrected, and pooling takes pixel errors as alike
  // near and far: 30 % too small to 60 % too large is what a claimed deviation is worth with 8 or
  // 15 poses.
  constexpr int kTrials = 200;
  RefineOptions options;
  options.range_offset_m = 0.0;  // these have none
  for (const int num_samples : {8, 15, 30}) {
    Matrix6d spread = Matrix6d::Zero();
    Matrix6d claimed = Matrix6d::Zero();
    for (std::uint32_t seed = 1; seed <= kTrials; ++seed) {
      auto scene = Noisy(0.5);
      scene.num_samples = num_samples;
      auto samples = test::SynthesizeSamples(scene);
      test::Random random(1000 + seed);  // the same poses, fresh noise
      for (auto& sample : samples) {
        Vector6d noise;
        noise << 0.005 * random.NormalVector(), 0.003 * random.NormalVector();
        const auto T_lidar_board =
            test::TestExtrinsic().inverse() * TransformFromPose(sample.camera.pose);
        sample.lidar.pose = PoseFromTransform(PerturbLeft(T_lidar_board, noise), test::TestBoard());
      }
      const RefinedExtrinsic refined = Refine(samples, options);
      ASSERT_TRUE(refined.IsUsable());
      const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
      spread += error * error.transpose() / kTrials;
      claimed += refined.covariance / kTrials;
    }
    for (int i = 0; i < 6; ++i) {
      const double ratio = std::sqrt(claimed(i, i) / spread(i, i));
      EXPECT_GT(ratio, num_samples < 30 ? 0.7 : 0.85) << num_samples << " samples, parameter " << i;
      EXPECT_LT(ratio, num_samples < 30 ? 1.6 : 1.15) << num_samples << " samples, parameter " << i;
    }
  }
}

// The residuals do not show it: the covariance has it from the prior, as the move that a refinement
// over longer ranges makes.
TEST(RefineExtrinsic, CovarianceHoldsTheMoveByARangeOffset) {
  const auto samples = test::SynthesizeSamples({});
  RefineOptions without;
  without.range_offset_m = 0.0;
  const Matrix6d added = Refine(samples).covariance - Refine(samples, without).covariance;
  auto longer = samples;
  for (BoardSample& sample : longer) {
    BoardPose& pose = sample.lidar.pose;
    pose.centre_m += 0.03 * pose.centre_m.normalized();
    for (Eigen::Vector3d& corner_m : pose.corners_m) corner_m += 0.03 * corner_m.normalized();
  }
  const Vector6d move =
      DifferenceLeft(Refine(samples).T_camera_lidar, Refine(longer).T_camera_lidar);
  for (int i = 0; i < 6; ++i) {
    // Linear, at the minimum: a tenth of the largest in the same unit.
    const double scale = i < 3 ? move.head<3>().norm() : move.tail<3>().norm();
    EXPECT_NEAR(std::sqrt(added(i, i)), std::abs(move[i]), 0.1 * scale) << i;
  }
}

TEST(RefineExtrinsic, ClaimsNoCovarianceWithoutRedundancy) {
  auto scene = Noisy(1.0);
  scene.num_samples = 3;
  RefineOptions centres_only;
  centres_only.corner_weight = 0.0;  // six residuals, six parameters: they fit exactly
  const RefinedExtrinsic refined = Refine(test::SynthesizeSamples(scene), centres_only);
  EXPECT_EQ(refined.status, RefineStatus::kConverged);
  EXPECT_TRUE(refined.covariance.array().isNaN().all());
}

TEST(RefineExtrinsic, DoesNotDependOnTheStart) {
  const auto samples = test::SynthesizeSamples(Noisy(1.0));
  const auto from_rough = Refine(samples);
  const auto from_truth =
      RefineExtrinsic(test::Pointers(samples), test::TestCamera(), test::TestExtrinsic(), {});
  EXPECT_THAT(from_rough.T_camera_lidar, test::IsNear(from_truth.T_camera_lidar, 1e-7, 1e-7));
}

TEST(RefineExtrinsic, NeedsThreeSamples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 2;
  const RefinedExtrinsic refined = Refine(test::SynthesizeSamples(scene));
  EXPECT_EQ(refined.status, RefineStatus::kDegenerate);
  EXPECT_FALSE(refined.IsUsable());
  EXPECT_TRUE(std::isnan(refined.covariance(0, 0)));
}

TEST(RefineExtrinsic, IsDegenerateWhereCentresAloneDoNotSuffice) {
  test::SyntheticSamplesOptions scene;
  scene.spread = 0.0;  // all boards at one place
  const auto samples = test::SynthesizeSamples(scene);
  RefineOptions centres_only;
  centres_only.corner_weight = 0.0;
  const RefinedExtrinsic refined = Refine(samples, centres_only);
  EXPECT_EQ(refined.status, RefineStatus::kDegenerate);
  EXPECT_TRUE(refined.covariance.array().isNaN().all());
  // The corners hold it.
  EXPECT_THAT(Refine(samples).T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-7, 1e-7));
}

TEST(RefineExtrinsic, IsDegenerateForCollinearCentresAlone) {
  auto samples = test::SynthesizeSamples({});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d centre_m(-0.5 + 0.03 * static_cast<double>(i), 0.1, 2.0);
    samples[i].camera.pose.centre_m = centre_m;
    samples[i].lidar.pose.centre_m = test::TestExtrinsic().inverse() * centre_m;
  }
  RefineOptions centres_only;
  centres_only.corner_weight = 0.0;
  EXPECT_EQ(Refine(samples, centres_only).status, RefineStatus::kDegenerate);
}

TEST(RefineExtrinsic, DoesNotConvergeFromBehindTheCamera) {
  const auto samples = test::SynthesizeSamples({});
  Eigen::Isometry3d T_behind = test::TestExtrinsic();
  T_behind.translation().z() -= 10.0;
  const auto refined = RefineExtrinsic(test::Pointers(samples), test::TestCamera(), T_behind, {});
  EXPECT_EQ(refined.status, RefineStatus::kNotConverged);
  auto broken = samples;
  broken[3].lidar.pose.centre_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Refine(broken).status, RefineStatus::kNotConverged);
}

TEST(RefineExtrinsic, SaysWhenIterationsRunOut) {
  RefineOptions options;
  options.max_iterations = 1;
  EXPECT_EQ(Refine(test::SynthesizeSamples(Noisy(1.0)), options).status,
            RefineStatus::kNotConverged);
}

TEST(RefinedExtrinsic, SummarisesInOneLine) {
  const std::string line = Refine(test::SynthesizeSamples(Noisy(1.0))).Summary();
  EXPECT_THAT(line, HasSubstr("converged: centres"));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0);
  EXPECT_EQ(RefinedExtrinsic{}.Summary(), "refinement not converged");
}

TEST(RefineOptions, NamesEachProblem) {
  EXPECT_THAT(RefineOptions{}.Problems(), IsEmpty());
  RefineOptions options;
  options.centre_weight = 0.0;
  options.corner_weight = -0.5;
  options.huber_px = 0.0;
  options.max_iterations = 0;
  EXPECT_THAT(options.Problems(),
              ElementsAre("centre_weight must be positive, is 0",
                          "corner_weight must not be negative, is -0.5",
                          "huber_px must be positive, is 0",
                          "max_iterations must be positive, is 0"));
  EXPECT_THROW(RefineExtrinsic({}, test::TestCamera(), RoughStart(), options),
               std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
