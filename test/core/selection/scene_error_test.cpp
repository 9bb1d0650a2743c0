#include "core/selection/scene_error.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/board/metres_per_pixel.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRotationSigmaRad = 0.01;
constexpr double kCentreSigmaM = 0.006;

Matrix6d Isotropic(double rotation_sigma_rad, double centre_sigma_m) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(rotation_sigma_rad), Eigen::Vector3d::Constant(centre_sigma_m);
  return sigma.cwiseAbs2().asDiagonal();
}

// Exact poses whose lidar is said to have the noise above.
std::vector<BoardSample> Scene(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    sample.lidar.pose.covariance = Isotropic(kRotationSigmaRad, kCentreSigmaM);
  }
  return samples;
}

SceneErrorPredictor PredictorOf(const std::vector<BoardSample>& samples) {
  return {samples, test::TestCamera(), test::TestExtrinsic(), {}};
}

// The least-squares extrinsic of exact poses plus noise, by Gauss and Newton with numeric
// derivatives: it shares no code with the predictor.
Vector6d NoisyEstimate(const std::vector<BoardSample>& samples,
                       const std::array<int, 3>& set,
                       test::Random* random) {
  Eigen::Matrix<double, 18, 1> noise;
  for (int i = 0; i < 3; ++i) {
    noise.segment<3>(6 * i) = random->NormalVector();
    noise.segment<3>(6 * i + 3) = random->NormalVector();
  }
  const auto residuals = [&](const Vector6d& delta) {
    const Eigen::Isometry3d T_camera_lidar = PerturbLeft(test::TestExtrinsic(), delta);
    Eigen::Matrix<double, 18, 1> r;
    for (int i = 0; i < 3; ++i) {
      const BoardSample& sample =
          samples[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])];
      const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
      const Vector6d off =
          DifferenceLeft(T_camera_lidar * TransformFromPose(sample.lidar.pose), T_camera_board);
      r.segment<3>(6 * i) = off.head<3>() / kRotationSigmaRad;
      r.segment<3>(6 * i + 3) = off.tail<3>() / kCentreSigmaM;
    }
    return Eigen::Matrix<double, 18, 1>(r + noise);
  };
  Eigen::Matrix<double, 18, 6> J;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    J.col(i) = (residuals(step) - residuals(-step)) / (2 * kStep);
  }
  return -(J.transpose() * J).ldlt().solve(J.transpose() * residuals(Vector6d::Zero()));
}

TEST(SceneErrorPredictor, PredictsTheErrorThatNoiseMakes) {
  const auto samples = Scene(12);
  const std::array<int, 3> set = {1, 4, 9};
  test::Random random(5);
  const CameraModel camera = test::TestCamera();
  double sum_mm2 = 0.0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    const Eigen::Isometry3d T_camera_lidar =
        PerturbLeft(test::TestExtrinsic(), NoisyEstimate(samples, set, &random));
    for (const BoardSample& sample : samples) {
      const Eigen::Vector2d off_px =
          camera.Project<double>(T_camera_lidar * sample.lidar.pose.centre_m) -
          camera.Project(sample.camera.pose.centre_m);
      const double mm_per_px = 1e3 * MetresPerPixel(sample.camera.pose, camera);
      sum_mm2 += mm_per_px * mm_per_px * off_px.squaredNorm() / 12;
    }
  }
  // A mean square of 2000 runs with two to six degrees of freedom: 1 sigma is at most sqrt(1 /
  // 2000) = 2.2 % of it, half of that of its root; 4 sigma.
  const double measured_mm = std::sqrt(sum_mm2 / kRuns);
  EXPECT_NEAR(PredictorOf(samples).PredictMm(set), measured_mm, 0.045 * measured_mm);
}

TEST(SceneErrorPredictor, ScalesWithTheNoise) {
  auto samples = Scene(8);
  const double once_mm = PredictorOf(samples).PredictMm({0, 3, 6});
  for (BoardSample& sample : samples) sample.lidar.pose.covariance *= 4;
  EXPECT_NEAR(PredictorOf(samples).PredictMm({0, 3, 6}), 2 * once_mm, 1e-9 * once_mm);
}

TEST(SceneErrorPredictor, AddsBothSensorsCovariances) {
  auto samples = Scene(8);
  const double lidar_only_mm = PredictorOf(samples).PredictMm({0, 3, 6});
  // Isotropic noise: it does not matter which sensor has how much of it.
  for (BoardSample& sample : samples) {
    sample.camera.pose.covariance = 0.3 * sample.lidar.pose.covariance;
    sample.lidar.pose.covariance *= 0.7;
  }
  EXPECT_NEAR(PredictorOf(samples).PredictMm({0, 3, 6}), lidar_only_mm, 1e-9 * lidar_only_mm);
}

TEST(SceneErrorPredictor, TakesNominalNoiseForUnknown) {
  auto samples = Scene(8);
  const NominalNoise nominal{0.03, 0.04, 3.0};
  for (BoardSample& sample : samples) {
    // The same in the lidar's own axes: along the ray and across it.
    const Eigen::Vector3d ray = sample.lidar.pose.centre_m.normalized();
    const double across_m = 3.0 * MetresPerPixel(sample.camera.pose, test::TestCamera());
    const Eigen::Matrix3d along = ray * ray.transpose();
    sample.lidar.pose.covariance = Isotropic(0.03, 0.0);
    sample.lidar.pose.covariance.bottomRightCorner<3, 3>() =
        0.04 * 0.04 * along + across_m * across_m * (Eigen::Matrix3d::Identity() - along);
  }
  const double known_mm = PredictorOf(samples).PredictMm({0, 3, 6});
  for (BoardSample& sample : samples) sample.lidar.pose.covariance.setZero();
  const SceneErrorPredictor unknown(samples, test::TestCamera(), test::TestExtrinsic(), nominal);
  EXPECT_NEAR(unknown.PredictMm({0, 3, 6}), known_mm, 1e-9 * known_mm);
}

TEST(SceneErrorPredictor, IsWorseForPosesInOnePlace) {
  auto samples = Scene(10);
  const double apart_mm = PredictorOf(samples).PredictMm({0, 1, 2});
  for (std::size_t i = 1; i < 3; ++i) samples[i] = samples[0];
  EXPECT_GT(PredictorOf(samples).PredictMm({0, 1, 2}), apart_mm);
}

}  // namespace
}  // namespace voqcal
