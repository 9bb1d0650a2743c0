#include "core/lidar_detection/outline_fit.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/lidar_detection/outline_edges.hpp"

namespace voqcal {
namespace {

constexpr double kSpacingM = 0.008;

OutlineModel Model() {
  OutlineModel model;
  model.width_m = 0.6;
  model.height_m = 0.8;
  model.blur_m = 0.004;
  return model;
}

/// A square grid of beams; hits are those inside the rectangle grown by `spill_m`.
std::vector<OutlineBeam> Grid(const OutlineModel& model,
                              const RectanglePose& pose,
                              double spill_m) {
  std::vector<OutlineBeam> beams;
  for (int i = -80; i <= 80; ++i) {
    for (int j = -80; j <= 80; ++j) {
      OutlineBeam beam;
      beam.position_m = kSpacingM * Eigen::Vector2d(i, j);
      const Eigen::Vector2d q_m = pose.T_rectangle_plane() * beam.position_m;
      beam.is_hit = std::abs(q_m.x()) < model.width_m / 2 + spill_m &&
                    std::abs(q_m.y()) < model.height_m / 2 + spill_m;
      beams.push_back(beam);
    }
  }
  return beams;
}

TEST(SearchOutline, FindsAnyAngleRoughly) {
  const OutlineModel model = Model();
  for (const double angle_rad : {0.0, 0.4, 0.9, 1.5, 2.2, 3.0}) {
    const RectanglePose truth{{0.03, -0.02}, angle_rad};
    const OutlineFit fit = SearchOutline(Grid(model, truth, 0.0), model, {0.0, 0.0});
    EXPECT_LT((fit.pose.centre_m - truth.centre_m).norm(), 0.02) << angle_rad;
    EXPECT_LT(std::abs(std::sin(fit.pose.angle_rad - angle_rad)), 0.05) << angle_rad;
  }
}

TEST(RefineOutline, IsExactToTheGridAndFindsTheSpill) {
  OutlineModel model = Model();
  model.spill_sigma_m = 0.01;
  const RectanglePose truth{{0.013, -0.007}, 0.7};
  const std::vector<OutlineBeam> beams = Grid(model, truth, 0.006);
  const OutlineFit fit = RefineOutline(beams, model, {{0.02, 0.0}, 0.72});
  // Along a slanted edge of 75 spacings the beams average out: spacing / sqrt(12 * 75) = 0.3 mm.
  EXPECT_LT((fit.pose.centre_m - truth.centre_m).norm(), 0.001);
  EXPECT_NEAR(fit.pose.angle_rad, truth.angle_rad, 0.003);
  EXPECT_NEAR(fit.spill_m, 0.006, 0.001);
}

TEST(EvaluateOutline, LikelihoodFallsAsItsInformationSays) {
  const OutlineModel model = Model();
  const RectanglePose truth{{0.0, 0.0}, 0.7};
  const std::vector<OutlineBeam> beams = Grid(model, truth, 0.0);
  const OutlineFit best = RefineOutline(beams, model, truth);
  const Eigen::Rotation2Dd R_plane_rectangle(best.pose.angle_rad);
  for (int axis = 0; axis < 2; ++axis) {
    constexpr double kStepM = 0.002;
    OutlineFit moved = best;
    moved.pose.centre_m += R_plane_rectangle * (kStepM * Eigen::Vector2d::Unit(axis));
    const double fall = best.log_likelihood - EvaluateOutline(beams, model, moved).log_likelihood;
    const double expected = 0.5 * kStepM * kStepM * best.information(axis, axis);
    // Expected against observed curvature: these hits are sharper than the model's blur says.
    EXPECT_GT(fall, 0.3 * expected);
    EXPECT_LT(fall, 3.0 * expected);
  }
}

TEST(MeasureEdges, RecoversLengthsOfAnotherRectangle) {
  const OutlineModel model = Model();
  OutlineModel truth = model;
  truth.width_m += 0.03;
  truth.height_m -= 0.02;
  const RectanglePose pose{{0.0, 0.0}, 0.7};
  const auto edges = MeasureEdges(Grid(truth, pose, 0.0), model, pose);
  const auto lengths_m = EdgeLengthsM(edges, model);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(lengths_m[i], i % 2 == 0 ? truth.width_m : truth.height_m, 0.002) << i;
    EXPECT_GT(edges[i].num_misses, 0);
  }
}

TEST(EvaluateOutline, NearSidesGrowByThickness) {
  OutlineModel model = Model();
  model.lean = {0.5, -0.25};
  // Rays that go towards +x under the face see the side face at -x, and those towards -y that at
  // +y.
  EXPECT_TRUE(model.SideLean().isApprox(Eigen::Vector4d(0, 0.5, 0.25, 0)));
  // sqrt(1 + 0.5^2), sqrt(1 + 0.25^2)
  EXPECT_TRUE(model.Stretch().isApprox(Eigen::Vector2d(1.1180339887, 1.0307764064), 1e-9));
}

}  // namespace
}  // namespace voqcal
