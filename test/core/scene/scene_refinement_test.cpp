#include "core/scene/scene_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/edge_field.hpp"
#include "core/scene/scene_cost.hpp"
#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"
#include "support/with_helpers.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = M_PI / 180.0;

/// A simulated room with pillars, seen at the rig's stops by a VLP-16 and a small camera.
class RefineBySceneTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SimulationOptions options;
    options.T_camera_lidar = test::TestExtrinsic();
    options.num_poses = 6;
    options.max_distance_m = 3.0;
    const Simulation simulation(options, test::TestBoard(), Camera());
    views_ = std::make_unique<std::vector<SceneView>>();
    for (int stop = 0; stop < options.num_poses; ++stop) {
      const double time_s = stop * (options.hold_s + options.move_s) + options.hold_s / 2;
      views_->push_back(
          MakeSceneView(simulation.Sweep(time_s), simulation.Image(time_s), Camera(), {}));
    }
  }
  static void TearDownTestSuite() { views_.reset(); }

  static CameraModel Camera() { return test::SmallCamera(LensModel::kEquidistant); }
  static Eigen::Isometry3d TurnedAboutY(double turn_deg) {
    Vector6d delta = Vector6d::Zero();
    delta[1] = kDeg * turn_deg;
    return PerturbLeft(test::TestExtrinsic(), delta);
  }
  static Matrix6d Covariance(double sigma_deg, double sigma_m) {
    Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(kDeg * sigma_deg), Eigen::Vector3d::Constant(sigma_m);
    return sigma.cwiseAbs2().asDiagonal();
  }

  static std::unique_ptr<std::vector<SceneView>> views_;
};

std::unique_ptr<std::vector<SceneView>> RefineBySceneTest::views_;

TEST_F(RefineBySceneTest, TurnsBackWhatIsTurned) {
  const Eigen::Isometry3d T_start = TurnedAboutY(0.5);
  const SceneRefinement refined =
      RefineByScene(*views_, Camera(), T_start, Covariance(0.5, 0.002), {});
  ASSERT_TRUE(refined.is_used) << refined.reason;
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
  EXPECT_LT(std::abs(error[1]), 0.14 * kDeg);  // a pixel of the camera
  EXPECT_LT(refined.surprise_after, refined.surprise_before);
  EXPECT_LT(std::sqrt(refined.covariance(1, 1)), 0.25 * kDeg);  // half of what was known
}

TEST_F(RefineBySceneTest, LeavesWhatIsKnownBetter) {
  const SceneRefinement refined =
      RefineByScene(*views_, Camera(), test::TestExtrinsic(), Covariance(0.002, 0.0001), {});
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
  EXPECT_LT(error.head<3>().norm(), 0.006 * kDeg);
}

TEST_F(RefineBySceneTest, ABlankHallGetsWhatWasGivenAndIsTold) {
  std::vector<SceneView> blank = *views_;
  for (SceneView& view : blank) view.edges.resize(10);
  const Eigen::Isometry3d T_start = TurnedAboutY(0.5);
  const SceneRefinement refined =
      RefineByScene(blank, Camera(), T_start, Covariance(0.5, 0.002), {});
  EXPECT_FALSE(refined.is_used);
  EXPECT_EQ(refined.T_camera_lidar.matrix(), T_start.matrix());
  EXPECT_THAT(refined.reason, HasSubstr("depth edges lie in the images"));
  EXPECT_FALSE(RefineByScene({}, Camera(), T_start, Covariance(0.5, 0.002), {}).is_used);
}

TEST_F(RefineBySceneTest, SameViewsSameAnswerOnAnyNumberOfThreads) {
  const auto refine = [](std::size_t num_helpers) {
    const test::WithHelpers helpers(num_helpers);
    return RefineByScene(*views_, Camera(), TurnedAboutY(0.3), Covariance(0.5, 0.01), {});
  };
  const SceneRefinement alone = refine(0);
  const SceneRefinement helped = refine(3);
  EXPECT_EQ(alone.T_camera_lidar.matrix(), helped.T_camera_lidar.matrix());
  EXPECT_EQ(alone.covariance, helped.covariance);
  EXPECT_EQ(alone.held_out_gain, helped.held_out_gain);
}

TEST_F(RefineBySceneTest, SurprisesHaveTheirNumericDerivatives) {
  const CameraModel camera = Camera();
  const std::vector<EdgeField> fields = MakeEdgeFields(*views_, 6.0);
  const auto edges = SceneEdgesInView(*views_, Camera(), test::TestExtrinsic());
  ASSERT_GT(edges.size(), 100U);
  int num_compared = 0;
  for (std::size_t i = 0; i < edges.size(); i += edges.size() / 20) {
    const SceneEdge* const edge = &edges[i];
    EdgeField::Patch patch;
    const auto surprise_at = [&](const SceneVector& unknowns, double* J) {
      const LeftPerturbation at(test::TestExtrinsic(), unknowns.head<6>());
      const EdgeLookup lookup{fields, camera, at, unknowns[6]};
      double alone = 0;
      double near = 0;
      SurprisesAt(&edge, 1, lookup, nullptr, &alone, J);
      SurprisesAt(&edge, 1, lookup, &patch, &near, J);
      EXPECT_EQ(alone, near);
      return near;
    };
    const auto value_at = [&](const SceneVector& unknowns) {
      return surprise_at(unknowns, nullptr);
    };
    Eigen::Matrix<double, 1, kSceneParameters> J;
    surprise_at(SceneVector::Zero(), J.data());
    for (const double turn_rad : {0.002, 0.02, -0.3}) {
      value_at(turn_rad * SceneVector::Unit(1));  // a pixel or two away, many, out of the image
    }
    for (int k = 0; k < kSceneParameters; ++k) {
      const SceneVector d = 1e-6 * SceneVector::Unit(k);
      const double numeric = (value_at(d) - value_at(-d)) / 2e-6;
      // Bilinear: a step over a pixel's border changes the slope. Steps of 1e-6 hardly meet one.
      if (std::abs(numeric - J[k]) < 1e-3 * (1 + std::abs(J[k]))) ++num_compared;
    }
  }
  EXPECT_GE(num_compared, 7 * 19);
}

TEST_F(RefineBySceneTest, SurprisesOfManyEdgesAreThoseOfEach) {
  const CameraModel camera = Camera();
  const std::vector<EdgeField> fields = MakeEdgeFields(*views_, 6.0);
  const auto all = SceneEdgesInView(*views_, camera, test::TestExtrinsic());
  ASSERT_GT(all.size(), 200U);  // more than are looked up at once
  std::vector<const SceneEdge*> edges;
  for (const SceneEdge& edge : all) edges.push_back(&edge);
  std::vector<EdgeField::Patch> patches(edges.size());
  for (const double turn_rad :
       {0.0, 0.002, -0.3}) {  // patches move, and some edges leave the image
    const LeftPerturbation at(test::TestExtrinsic(), turn_rad * Vector6d::Unit(1));
    const EdgeLookup lookup{fields, camera, at, 0.001};
    std::vector<double> together(edges.size());
    std::vector<double> J_together(kSceneParameters * edges.size());
    SurprisesAt(
        edges.data(), edges.size(), lookup, patches.data(), together.data(), J_together.data());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      double alone = 0;
      std::array<double, kSceneParameters> J_alone{};
      SurprisesAt(&edges[i], 1, lookup, nullptr, &alone, J_alone.data());
      ASSERT_EQ(together[i], alone) << i;
      ASSERT_TRUE(
          std::equal(J_alone.begin(), J_alone.end(), J_together.data() + kSceneParameters * i))
          << i;
    }
  }
}

TEST(SceneRefinementOptions, NamesEachProblem) {
  SceneRefinementOptions options;
  options.blurs_px = {};
  options.min_edges = 0;
  EXPECT_THAT(options.Problems(), ::testing::SizeIs(2));
}

}  // namespace
}  // namespace voqcal
