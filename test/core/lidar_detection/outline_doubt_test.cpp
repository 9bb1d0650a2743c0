#include "core/lidar_detection/outline_doubt.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

OutlineModel Model() {
  OutlineModel model;
  model.width_m = 0.6;
  model.height_m = 0.8;
  model.blur_m = 0.003;
  return model;
}

/// Level lines of dense beams, `gap_m` apart, one of them at height `first_m`; the rectangle stands
/// upright at `centre_m`.
std::vector<OutlineBeam> Lines(const Eigen::Vector2d& centre_m,
                               double gap_m,
                               double first_m,
                               const OutlineModel& model = Model()) {
  std::vector<OutlineBeam> beams;
  const int num_lines = static_cast<int>(0.7 / gap_m);
  for (int line = -num_lines; line <= num_lines; ++line) {
    for (int i = -80; i <= 80; ++i) {
      const Eigen::Vector2d position_m(0.01 * i, first_m + gap_m * line);
      const Eigen::Vector2d out_m = (position_m - centre_m).cwiseAbs();
      const bool is_hit = out_m.x() < model.width_m / 2 && out_m.y() < model.height_m / 2;
      if (out_m.norm() < 0.7) beams.push_back({position_m, is_hit});
    }
  }
  return beams;
}

TEST(SettleOutline, TakesTheMiddleOfWhatTheLinesLeaveOpen) {
  // Lines at -0.45, -0.3, ... 0.45: the upper edge lies between 0.3 and 0.45, the lower one between
  // -0.45 and -0.3, so the centre may be from -0.05 to 0.05.
  const OutlineModel model = Model();
  const auto beams = Lines({0.0, 0.0}, 0.15, 0.0);
  const OutlineFit start = RefineOutline(beams, model, {{0.0, 0.03}, 0.0});
  const OutlineFit settled = SettleOutline(beams, model, start);
  EXPECT_NEAR(settled.pose.centre_m.y(), 0.0, 0.005);
  const double sigma_m = std::sqrt(settled.PoseCovariance()(1, 1));
  // Evenly spread, but each end is as far from a line as the 60 beams of it need not to hit by the
  // blur of one: ln 60.
  const double open_m = 0.1 - 2 * model.blur_m * std::log(60.0);
  EXPECT_NEAR(sigma_m, open_m / std::sqrt(12.0), 0.002);
  EXPECT_NEAR(CornerSigmaM(settled, model), sigma_m, 0.006);
}

TEST(SettleOutline, KeepsWhatItAddsAlongTheFirstDirectionWhenItSettlesTheSecond) {
  // Beams at the corners of squares of 0.15 m: the centre is as free along x as along y.
  const OutlineModel model = Model();
  std::vector<OutlineBeam> beams;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      const Eigen::Vector2d position_m = 0.15 * Eigen::Vector2d(i + 0.5, j);
      beams.push_back(
          {position_m, std::abs(position_m.x()) < 0.3 && std::abs(position_m.y()) < 0.4});
    }
  }
  const OutlineFit start = RefineOutline(beams, model, {{0.02, 0.01}, 0.0});
  const OutlineFit settled = SettleOutline(beams, model, start);
  const Eigen::Matrix3d covariance = settled.PoseCovariance();
  // Hits end at 0.225 and 0.3, misses begin at 0.375 and 0.45: x may move by 0.075 each way, y by
  // 0.05.
  EXPECT_LT(std::sqrt(covariance(0, 0)), 0.15 / std::sqrt(12.0) + 0.01);
  EXPECT_LT(std::sqrt(covariance(1, 1)), 0.10 / std::sqrt(12.0) + 0.01);
}

TEST(SettleOutline, LeavesASharpFitAlone) {
  const OutlineModel model = Model();
  const auto beams = Lines({0.01, 0.0}, 0.01, 0.0);
  const OutlineFit fit = RefineOutline(beams, model, {{0.0, 0.0}, 0.02});
  const OutlineFit settled = SettleOutline(beams, model, fit);
  EXPECT_EQ(settled.pose.centre_m, fit.pose.centre_m);
  EXPECT_EQ(settled.information, fit.information);
}

TEST(CornerSigmaM, IsThatOfTheCentreWhereTheTurnIsKnown) {
  OutlineFit fit;
  fit.information.setIdentity();
  fit.information.diagonal() << 1 / 4e-6, 1 / 9e-6, 1e12, 1.0, 1.0;  // 2 mm, 3 mm, no turn
  EXPECT_NEAR(CornerSigmaM(fit, Model()), 0.003, 1e-6);
}

TEST(HasTurnedRival, IsSoWhereOneLineIsAllThatHits) {
  const OutlineModel model = Model();
  const auto dense = Lines({0.0, 0.0}, 0.01, 0.0);
  EXPECT_FALSE(HasTurnedRival(dense, model, RefineOutline(dense, model, {{0.0, 0.0}, 0.0})));
  // A board held as a diamond leaves the same chord on a line through its middle as its mirror
  // image.
  std::vector<OutlineBeam> single;
  const RectanglePose diamond{{0.0, 0.0}, 0.6};
  for (const double y_m : {-0.55, 0.0, 0.55}) {
    for (int i = -80; i <= 80; ++i) {
      const Eigen::Vector2d position_m(0.01 * i, y_m);
      const Eigen::Vector2d q_m = diamond.T_rectangle_plane() * position_m;
      single.push_back({position_m, std::abs(q_m.x()) < 0.3 && std::abs(q_m.y()) < 0.4});
    }
  }
  EXPECT_TRUE(HasTurnedRival(single, model, RefineOutline(single, model, diamond)));
}

TEST(HasRivalSize, IsSoWhereTheBeamsShowAnotherSize) {
  const Eigen::Vector2d lower(0.0, -1.0);
  const OutlineModel model = Model();
  OutlineModel other = model;
  other.height_m -= 0.1;
  const auto right = Lines({0.0, 0.0}, 0.03, 0.0);
  const auto wrong = Lines({0.0, 0.0}, 0.03, 0.0, other);
  const OutlineFit right_fit = RefineOutline(right, model, {{0.0, 0.0}, 0.0});
  const OutlineFit wrong_fit = RefineOutline(wrong, model, {{0.0, 0.0}, 0.0});
  EXPECT_FALSE(HasRivalSize(right, model, right_fit, lower));
  EXPECT_TRUE(HasRivalSize(wrong, model, wrong_fit, lower));
}

TEST(HasRivalSize, IsNotSoWhereTheLinesLeaveTheSizeOpen) {
  // Lines at -0.5, -0.25, 0, 0.25, 0.5 of a thing 0.75 m high: it may as well be 0.8 m high.
  OutlineModel other = Model();
  other.height_m = 0.75;
  const auto beams = Lines({0.0, 0.0}, 0.25, 0.0, other);
  const OutlineFit fit = RefineOutline(beams, Model(), {{0.0, 0.03}, 0.0});
  for (const double grows : {-1.0, 1.0}) {
    EXPECT_FALSE(HasRivalSize(beams, Model(), fit, {0.0, grows})) << grows;
  }
}

}  // namespace
}  // namespace voqcal
