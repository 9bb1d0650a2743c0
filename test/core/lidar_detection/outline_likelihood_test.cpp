#include "core/lidar_detection/outline_likelihood.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

OutlineModel SlantedModel() {
  OutlineModel model;
  model.width_m = 0.6;
  model.height_m = 0.8;
  model.blur_m = 0.012;
  model.spill_m = 0.003;
  model.thickness_m = 0.02;
  model.lean = {0.3, -0.5};
  return model;
}

// Around the rectangle, each hit or not by chance: all that the likelihood may be asked about.
std::vector<OutlineBeam> Beams() {
  test::Random random(5);
  std::vector<OutlineBeam> beams(2000);
  for (OutlineBeam& beam : beams) {
    beam.position_m = {random.Uniform(-0.6, 0.6), random.Uniform(-0.6, 0.6)};
    beam.is_hit = random.Uniform(0, 1) < 0.5;
  }
  return beams;
}

OutlineFit At() {
  OutlineFit at;
  at.pose = {{0.02, -0.01}, 0.4};
  at.spill_m = 0.004;
  at.thickness_m = 0.015;
  return at;
}

/// As the fit steps: the centre along the rectangle's axes.
OutlineFit Moved(OutlineFit at, Eigen::Index parameter, double step) {
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  if (parameter < 2) shift_m[parameter] = step;
  at.pose.centre_m += Eigen::Rotation2Dd(at.pose.angle_rad) * shift_m;
  if (parameter == 2) at.pose.angle_rad += step;
  if (parameter == 3) at.spill_m += step;
  if (parameter == 4) at.thickness_m += step;
  return at;
}

TEST(OutlineLogLikelihood, IsThatOfEvaluateOutline) {
  EXPECT_DOUBLE_EQ(OutlineLogLikelihood(Beams(), SlantedModel(), At()),
                   EvaluateOutline(Beams(), SlantedModel(), At()).log_likelihood);
}

OutlineModel ExpectingModel() {
  OutlineModel model = SlantedModel();
  model.expected = ExpectedRectangle{{{0.05, 0.02}, 0.3}, Eigen::Matrix3d::Zero()};
  model.expected->information << 9e4, 2e4, 1e3, 2e4, 7e4, 0, 1e3, 0, 5e4;
  return model;
}

TEST(WithoutExpected, IsWhatTheBeamsTell) {
  const std::vector<OutlineBeam> beams = Beams();
  const OutlineFit with = EvaluateOutline(beams, ExpectingModel(), At());
  const OutlineFit without = WithoutExpected(ExpectingModel(), with);
  const OutlineFit told = EvaluateOutline(beams, SlantedModel(), At());
  EXPECT_TRUE(without.PoseCovariance().isApprox(told.PoseCovariance(), 1e-6));
  EXPECT_GT(told.PoseCovariance()(0, 0), with.PoseCovariance()(0, 0));
}

TEST(WithoutExpected, IsWideWhereNoBeamTells) {
  const OutlineFit none =
      WithoutExpected(ExpectingModel(), EvaluateOutline({}, ExpectingModel(), At()));
  EXPECT_TRUE(none.PoseCovariance().isApprox(Eigen::Matrix3d::Identity(), 1e-6));
}

class DifferentiateOutlineOf : public testing::TestWithParam<OutlineModel> {};

TEST_P(DifferentiateOutlineOf, HasTheGradientOfTheLikelihood) {
  const std::vector<OutlineBeam> beams = Beams();
  const OutlineModel& model = GetParam();
  const OutlineSlope slope = DifferentiateOutline(beams, model, At());
  // Over such a step a beam's probability is a parabola to 1e-6; where it counts as flat
  // (kFlat) its logarithm jumps by 5e-5, which a step of some beams' passing makes 1 in all.
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double after = OutlineLogLikelihood(beams, model, Moved(At(), i, kStep));
    const double before = OutlineLogLikelihood(beams, model, Moved(At(), i, -kStep));
    const double numeric = (after - before) / (2 * kStep);
    EXPECT_NEAR(slope.gradient[i], numeric, 0.01 * slope.gradient.norm()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutExpectation,
                         DifferentiateOutlineOf,
                         testing::Values(SlantedModel(), ExpectingModel()));

}  // namespace
}  // namespace voqcal
