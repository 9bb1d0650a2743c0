#include "core/assessment/scores.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRadiansPerDegree = M_PI / 180.0;

BoardSample CleanSample() { return test::SynthesizeSamples({}).front(); }

TEST(MetresPerPixel, IsDepthOverFocalLengthForAFacingBoard) {
  CameraModel camera;
  camera.lens = LensModel::kPlumbBob;
  camera.width_px = camera.height_px = 1000;
  camera.fx_px = camera.fy_px = 800.0;
  camera.cx_px = camera.cy_px = 500.0;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T_camera_board.translation() = Eigen::Vector3d(0.1, -0.2, 4.0);
  const BoardPose pose = PoseFromTransform(T_camera_board, test::TestBoard());
  EXPECT_NEAR(MetresPerPixel(pose, camera), 4.0 / 800.0, 1e-12);
}

TEST(ScorePose, IsZeroAtTheTruth) {
  const PoseScore score = ScorePose(CleanSample(), test::TestCamera(), test::TestExtrinsic());
  EXPECT_NEAR(score.centre_px, 0.0, 1e-9);
  EXPECT_NEAR(score.centre_mm, 0.0, 1e-9);
  EXPECT_NEAR(score.corner_mm, 0.0, 1e-9);
  EXPECT_NEAR(score.normal_deg, 0.0, 1e-6);
}

TEST(ScorePose, MeasuresAKnownShift) {
  // The whole board 10 mm to the side: corners 10 mm, normals 0, the centre 10 mm at its depth.
  const BoardSample sample = CleanSample();
  const CameraModel camera = test::TestCamera();
  Eigen::Isometry3d T_shifted = test::TestExtrinsic();
  T_shifted.translation().x() += 0.010;
  const PoseScore score = ScorePose(sample, camera, T_shifted);
  EXPECT_NEAR(score.corner_mm, 10.0, 1e-9);
  EXPECT_NEAR(score.normal_deg, 0.0, 1e-6);
  const Eigen::Vector3d centre_m = sample.camera.pose.centre_m;
  const double px =
      (camera.Project<double>(centre_m + Eigen::Vector3d(0.010, 0, 0)) - camera.Project(centre_m))
          .norm();
  EXPECT_NEAR(score.centre_px, px, 1e-9);
  EXPECT_NEAR(score.centre_mm, 1000.0 * px * MetresPerPixel(sample.camera.pose, camera), 1e-9);
  // Pixels count across the view only, and the board is tilted: 10 mm within its obliqueness.
  EXPECT_NEAR(score.centre_mm, 10.0, 3.0);
}

TEST(ScorePose, MeasuresAKnownRotation) {
  BoardSample sample = CleanSample();
  Eigen::Isometry3d T_lidar_board = TransformFromPose(sample.lidar.pose);
  T_lidar_board.linear() = T_lidar_board.linear() * ExpSO3({2.0 * kRadiansPerDegree, 0, 0});
  sample.lidar.pose = PoseFromTransform(T_lidar_board, test::TestBoard());
  const PoseScore score = ScorePose(sample, test::TestCamera(), test::TestExtrinsic());
  EXPECT_NEAR(score.normal_deg, 2.0, 1e-6);
  EXPECT_NEAR(score.centre_px, 0.0, 1e-9);
  // Each corner is half the height from the x axis: chord 2 sin(1 deg) * h / 2.
  EXPECT_NEAR(score.corner_mm, 1000.0 * 0.85 * std::sin(1.0 * kRadiansPerDegree), 1e-6);
}

TEST(ScorePose, TakesTheNearerHalfTurn) {
  BoardSample sample = CleanSample();
  sample.lidar.pose = TurnedByHalf(sample.lidar.pose);
  EXPECT_NEAR(ScorePose(sample, test::TestCamera(), test::TestExtrinsic()).corner_mm, 0.0, 1e-9);
}

TEST(ScorePose, IsNanBehindTheCamera) {
  Eigen::Isometry3d T_behind = test::TestExtrinsic();
  T_behind.translation().z() -= 10.0;
  EXPECT_TRUE(std::isnan(ScorePose(CleanSample(), test::TestCamera(), T_behind).centre_mm));
}

TEST(ScoreScene, SummarisesThePoses) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 2;
  auto samples = test::SynthesizeSamples(scene);
  // One pose exact, the other's corners 8 mm off: mean 4, population deviation 4, max 8.
  for (auto& corner_m : samples[1].lidar.pose.corners_m) corner_m.z() += 0.008;
  const SceneScore score =
      ScoreScene(test::Pointers(samples), test::TestCamera(), test::TestExtrinsic());
  ASSERT_EQ(score.poses.size(), 2u);
  EXPECT_NEAR(score.corner_mm.mean, 4.0, 1e-9);
  EXPECT_NEAR(score.corner_mm.std, 4.0, 1e-9);
  EXPECT_NEAR(score.corner_mm.max, 8.0, 1e-9);
}

TEST(ScoreScene, HasNoFiguresWithoutPoses) {
  const SceneScore score = ScoreScene({}, test::TestCamera(), test::TestExtrinsic());
  EXPECT_TRUE(std::isnan(score.centre_mm.mean));
  EXPECT_TRUE(std::isnan(score.centre_mm.max));
}

TEST(LeaveOneOutScore, ScoresEachPoseByTheOthers) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 8;
  scene.lidar_centre_noise_m = 0.005;
  scene.lidar_rotation_noise_rad = 0.01;
  const auto samples = test::SynthesizeSamples(scene);
  const auto all = test::Pointers(samples);
  const SceneScore score = LeaveOneOutScore(all, test::TestCamera(), test::TestExtrinsic(), {});
  ASSERT_EQ(score.poses.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<const BoardSample*> others;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j != i) others.push_back(all[j]);
    }
    const auto refined = RefineExtrinsic(others, test::TestCamera(), test::TestExtrinsic(), {});
    const PoseScore expected = ScorePose(*all[i], test::TestCamera(), refined.T_camera_lidar);
    EXPECT_EQ(score.poses[i].centre_mm, expected.centre_mm);
  }
  const auto refined = RefineExtrinsic(all, test::TestCamera(), test::TestExtrinsic(), {});
  EXPECT_GT(score.centre_mm.mean,
            ScoreScene(all, test::TestCamera(), refined.T_camera_lidar).centre_mm.mean);
}

TEST(LeaveOneOutScore, NeedsFourSamples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 3;
  const auto samples = test::SynthesizeSamples(scene);
  const SceneScore score =
      LeaveOneOutScore(test::Pointers(samples), test::TestCamera(), test::TestExtrinsic(), {});
  EXPECT_TRUE(std::isnan(score.centre_mm.mean));
}

}  // namespace
}  // namespace voqcal
