#include "core/simulation/camera_simulator.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "core/simulation/board_script.hpp"
#include "simulated_rig.hpp"
#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

std::vector<cv::Point2f> TrueCornersPx(const test::SimulatedRig& rig,
                                       const Eigen::Isometry3d& T_lidar_board) {
  std::vector<cv::Point2f> corners_px;
  for (const Eigen::Vector3d& corner : rig.board.InnerCornersBoardM()) {
    const Eigen::Vector3d in_camera_m = rig.options.T_camera_lidar * T_lidar_board * corner;
    const Eigen::Vector2d pixel = rig.camera.Project<double>(in_camera_m);
    corners_px.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  }
  return corners_px;
}

float LeastSpacingPx(const std::vector<cv::Point2f>& corners_px) {
  float least_px = 1e9F;
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least_px = std::min(least_px, static_cast<float>(cv::norm(corners_px[i] - corners_px[j])));
    }
  }
  return least_px;
}

class RenderOfLens : public testing::TestWithParam<LensModel> {};

TEST_P(RenderOfLens, ShowsTheCornersWhereTheyProject) {
  test::SimulatedRig rig = test::CleanRig(GetParam());
  rig.options.max_distance_m = 3.0;  // squares large enough for an unbiased measurement
  const Room room;
  const BoardScript script(rig.options, rig.board, rig.camera, room);
  const CameraSimulator camera(rig.options, rig.board, rig.camera, room);
  cv::Point2d bias_px;
  int num_corners = 0;
  for (int stop = 0; stop < rig.options.num_poses; ++stop) {
    const Eigen::Isometry3d T_lidar_board =
        script.T_lidar_board(test::TimeAtStopS(rig.options, stop));
    cv::Mat grey;
    cv::cvtColor(camera.Render(T_lidar_board, stop), grey, cv::COLOR_BGR2GRAY);
    const std::vector<cv::Point2f> true_px = TrueCornersPx(rig, T_lidar_board);
    // A window that no neighbouring corner reaches into.
    const int half = std::clamp(static_cast<int>(0.4F * LeastSpacingPx(true_px)), 2, 6);
    std::vector<cv::Point2f> seen_px = true_px;
    for (auto& corner : seen_px) corner += cv::Point2f(0.4F, -0.3F);
    cv::cornerSubPix(grey, seen_px, {half, half}, {-1, -1}, {cv::TermCriteria::EPS, 100, 1e-4});
    for (std::size_t i = 0; i < true_px.size(); ++i) {
      const cv::Point2f error_px = seen_px[i] - true_px[i];
      EXPECT_LT(cv::norm(error_px), 0.15) << "stop " << stop << " corner " << i;
      bias_px += cv::Point2d(error_px);
      ++num_corners;
    }
  }
  EXPECT_LT(cv::norm(bias_px) / num_corners, 0.05);
}

INSTANTIATE_TEST_SUITE_P(AllLenses,
                         RenderOfLens,
                         testing::Values(LensModel::kEquidistant,
                                         LensModel::kPlumbBob,
                                         LensModel::kRational));

TEST(PixelRays, InvertTheLens) {
  for (const LensModel lens :
       {LensModel::kEquidistant, LensModel::kPlumbBob, LensModel::kRational}) {
    const CameraModel camera = test::HalfSize(test::SmallCamera(lens));
    const PixelRays rays(camera);
    for (int y = 0; y <= camera.height_px; y += 7) {
      for (int x = 0; x <= camera.width_px; x += 7) {
        const Eigen::Vector3d ray = rays.AtCorner(x, y).cast<double>();
        if (!ray.allFinite()) continue;  // beyond the fold of the lens
        const Eigen::Vector2d pixel = camera.Project<double>(ray);
        // A float's rounding, 6e-8 of 225 px, thrice; near the fold the inverse loses digits.
        EXPECT_LT((pixel - Eigen::Vector2d(x - 0.5, y - 0.5)).norm(), 1e-3) << ToString(lens);
      }
    }
  }
}

TEST(Render, DarkAndBrightSquaresHaveTheirLevels) {
  test::SimulatedRig rig = test::CleanRig();
  rig.camera = test::HalfSize(rig.camera);
  const Room room;
  const BoardScript script(rig.options, rig.board, rig.camera, room);
  const CameraSimulator camera(rig.options, rig.board, rig.camera, room);
  const Eigen::Isometry3d T_lidar_board = script.T_lidar_board(0.0);
  const cv::Mat image = camera.Render(T_lidar_board, 0);
  ASSERT_EQ(image.type(), CV_8UC3);
  const auto level_at = [&](double x_m, double y_m) {
    const Eigen::Vector2d pixel = rig.camera.Project<double>(
        rig.options.T_camera_lidar * T_lidar_board * Eigen::Vector3d(x_m, y_m, 0));
    return image.at<cv::Vec3b>(static_cast<int>(std::lround(pixel.y())),
                               static_cast<int>(std::lround(pixel.x())));
  };
  const Eigen::Vector3d corner_m = rig.board.InnerCornersBoardM().front();
  const double half_m = rig.board.square_m / 2;
  // Albedos 0.08 and 0.80, lit by 0.7 to 1.05.
  EXPECT_NEAR(level_at(corner_m.x() - half_m, corner_m.y() - half_m)[1], 18, 4);
  EXPECT_NEAR(level_at(corner_m.x() + half_m, corner_m.y() - half_m)[1], 178, 36);
}

TEST(Render, NoiseHasItsSigmaAndChangesFromFrameToFrame) {
  VOQCAL_LEAVE_TO_RELEASE();
  test::SimulatedRig rig = test::CleanRig();
  rig.camera = test::HalfSize(rig.camera);
  const Room room;
  const Eigen::Isometry3d T_lidar_board =
      BoardScript(rig.options, rig.board, rig.camera, room).T_lidar_board(0.0);
  rig.options.image_noise = 3.0;
  const CameraSimulator camera(rig.options, rig.board, rig.camera, room);
  cv::Mat first;
  cv::Mat second;
  camera.Render(T_lidar_board, 0).convertTo(first, CV_32F);
  camera.Render(T_lidar_board, 100000).convertTo(second, CV_32F);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(first - second, mean, sigma);
  for (int channel = 0; channel < 3; ++channel) {
    // The difference has twice the variance of the noise and of its rounding (1/12). Neighbouring
    // frames read one table of 131,072 numbers, so its error counts: 3 / sqrt(131072) = 0.01.
    EXPECT_NEAR(mean[channel], 0.0, 0.06);
    EXPECT_NEAR(sigma[channel], std::sqrt(2 * (9.0 + 1.0 / 12.0)), 0.1);
  }
}

TEST(Render, ChangesNothingAwayFromTheBoard) {
  VOQCAL_LEAVE_TO_RELEASE();
  test::SimulatedRig rig = test::CleanRig();
  rig.camera = test::HalfSize(rig.camera);
  const Room room;
  const BoardScript script(rig.options, rig.board, rig.camera, room);
  const CameraSimulator camera(rig.options, rig.board, rig.camera, room);
  const cv::Mat first = camera.Render(script.T_lidar_board(0.0), 0);
  Eigen::Isometry3d T_behind = Eigen::Isometry3d::Identity();
  T_behind.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  T_behind.translation() = Eigen::Vector3d(-3.0, 0.0, 0.0);
  const cv::Mat empty = camera.Render(T_behind, 0);
  const cv::Mat difference = cv::Mat(cv::abs(first - empty)).reshape(1);
  const int num_changed = cv::countNonZero(difference) / 3;
  EXPECT_GT(num_changed, 300);
  EXPECT_LT(num_changed, rig.camera.width_px * rig.camera.height_px / 4);
}

}  // namespace
}  // namespace voqcal
