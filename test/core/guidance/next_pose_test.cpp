#include "core/guidance/next_pose.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

GuidedRig TestGuidedRig() { return {test::TestBoard(), test::TestCamera(), {}}; }

// Exact samples as the sensors are expected to see them, at the places of the synthetic ones.
std::vector<BoardSample> Samples(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    const std::int64_t id = sample.id;
    sample = ExpectedSample(TransformFromPose(sample.camera.pose),
                            test::TestExtrinsic(),
                            test::TestBoard(),
                            test::TestCamera(),
                            {});
    sample.id = id;
  }
  return samples;
}

GuidanceState StateOf(const std::vector<BoardSample>& samples) {
  GuidanceState state;
  state.samples = test::Pointers(samples);
  if (samples.size() < 3) return state;
  state.belief = ExtrinsicBelief{test::TestExtrinsic(), {}, {}};
  state.covariance =
      ExtrinsicInformation(state.samples, *state.belief, LikelihoodOptions{}, 16).Covariance();
  return state;
}

NextPose Propose(const std::vector<BoardSample>& samples, const GuidanceOptions& options = {}) {
  return ProposeNextPose(StateOf(samples), TestGuidedRig(), options);
}

bool IsSeen(const NextPose& next) {
  return IsInView(
      next.T_camera_board, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {}, {});
}

TEST(ProposeNextPose, WithoutASampleStartsFromTheCamera) {
  const NextPose next = Propose({});
  EXPECT_EQ(next.problem, "");
  EXPECT_TRUE(std::isinf(next.worst.error));
  EXPECT_FALSE(next.is_enough);
  EXPECT_FALSE(next.T_lidar_board);
  EXPECT_TRUE(std::isfinite(next.predicted_worst_error));
  EXPECT_THAT(next.advice, StartsWith("Hold the board "));
}

TEST(ProposeNextPose, TakesTheExtrinsicFromTheOnlySample) {
  std::vector<BoardSample> samples = Samples(1);
  for (const bool is_turned : {false, true}) {
    if (is_turned) samples[0].lidar.pose = TurnedByHalf(samples[0].lidar.pose);
    const NextPose next = Propose(samples);
    EXPECT_EQ(next.problem, "");
    ASSERT_TRUE(next.T_lidar_board);
    const Eigen::Isometry3d T_camera_lidar = next.T_camera_board * next.T_lidar_board->inverse();
    EXPECT_LT(RotationAngleBetween(T_camera_lidar.linear(), test::TestExtrinsic().linear()), 1e-6);
    EXPECT_TRUE(IsSeen(next));
    EXPECT_FALSE(next.is_enough);
    EXPECT_THAT(next.advice, StartsWith("Move the board "));
  }
}

TEST(ProposeNextPose, LowersTheWorstErrorWhateverThereIs) {
  for (int num_samples = 1; num_samples <= 8; ++num_samples) {
    const NextPose next = Propose(Samples(num_samples));
    EXPECT_EQ(next.problem, "") << num_samples;
    EXPECT_TRUE(IsSeen(next)) << num_samples;
    EXPECT_LT(next.predicted_worst_error, next.worst.error) << num_samples;
    EXPECT_GT(next.predicted_worst_error, 0.0) << num_samples;
  }
}

// Once the asked sample is there, the error is what was promised, and the pose is not asked again.
TEST(ProposeNextPose, KeepsItsPromise) {
  std::vector<BoardSample> samples = Samples(4);
  for (int i = 0; i < 4; ++i) {
    const NextPose next = Propose(samples);
    for (const BoardSample& sample : samples) {
      const Eigen::Isometry3d known = TransformFromPose(sample.camera.pose);
      EXPECT_TRUE((known.translation() - next.T_camera_board.translation()).norm() > 0.29 ||
                  AngleBetween(known.linear().col(2), next.T_camera_board.linear().col(2)) > 0.25);
    }
    BoardSample sample = ExpectedSample(
        next.T_camera_board, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {});
    // An expected sample stands for four times as many returns.
    auto& points = sample.lidar.points_lidar_m.points;
    const auto thinned = points;
    for (int k = 1; k < kExpectedThinning; ++k) {
      points.insert(points.end(), thinned.begin(), thinned.end());
    }
    samples.push_back(sample);
    EXPECT_NEAR(Propose(samples).worst.error / next.predicted_worst_error, 1.0, 1e-3);
  }
}

TEST(ProposeNextPose, SaysEnoughWhenTheToleranceIsMet) {
  const std::vector<BoardSample> samples = Samples(8);
  GuidanceOptions options;
  const double worst_mm = Propose(samples).worst.error;
  options.enough.tolerance.tolerance = 0.99 * worst_mm;
  EXPECT_FALSE(Propose(samples, options).is_enough);
  options.enough.tolerance.tolerance = 1.01 * worst_mm;
  const NextPose next = Propose(samples, options);
  EXPECT_TRUE(next.is_enough);
  EXPECT_THAT(next.advice, HasSubstr("Enough"));
  EXPECT_EQ(next.problem, "");  // one more would still help: its pose is there
}

TEST(ProposeNextPose, NeverSaysEnoughOfFewerSamplesThanAreAsked) {
  const std::vector<BoardSample> samples = Samples(8);
  GuidanceOptions options;
  options.enough.tolerance.tolerance = 1000.0;
  EXPECT_TRUE(Propose(samples, options).is_enough);
  options.enough.min_samples = 9;
  EXPECT_FALSE(Propose(samples, options).is_enough);
}

// The same 1 sigmas, but nothing of an error in one parameter is made up for by another.
TEST(ProposeNextPose, JudgesEnoughByThePublishedCovarianceItself) {
  const std::vector<BoardSample> samples = Samples(8);
  GuidanceState state = StateOf(samples);
  const double least_mm = Propose(samples).worst.error;
  state.covariance = Matrix6d(state.covariance->diagonal().asDiagonal());
  GuidanceOptions options;
  const double published_mm =
      ErrorScene(test::TestCamera(), test::TestExtrinsic(), options.enough.tolerance)
          .Worst(*state.covariance)
          .error;
  ASSERT_GT(published_mm, 1.1 * least_mm);
  options.enough.tolerance.tolerance = 1.05 * least_mm;
  NextPose next = ProposeNextPose(state, TestGuidedRig(), options);
  EXPECT_EQ(next.worst.error, published_mm);
  EXPECT_FALSE(next.is_enough);
  options.enough.tolerance.tolerance = 1.01 * published_mm;
  next = ProposeNextPose(state, TestGuidedRig(), options);
  EXPECT_TRUE(next.is_enough);
}

TEST(ProposeNextPose, NeverSaysEnoughWithoutAPublishedCovariance) {
  const std::vector<BoardSample> samples = Samples(8);
  GuidanceState state = StateOf(samples);
  state.covariance.reset();
  GuidanceOptions options;
  options.enough.tolerance.tolerance = 1000.0;
  EXPECT_FALSE(ProposeNextPose(state, TestGuidedRig(), options).is_enough);
}

TEST(ProposeNextPose, KeepsWhatThePublishedCovarianceHasMore) {
  const std::vector<BoardSample> samples = Samples(6);
  GuidanceState state = StateOf(samples);
  const NextPose plain = ProposeNextPose(state, TestGuidedRig(), {});
  state.covariance = Matrix6d(4.0 * state.covariance.value());
  const NextPose wider = ProposeNextPose(state, TestGuidedRig(), {});
  EXPECT_NEAR(wider.worst.error, 2.0 * plain.worst.error, 1e-9 * plain.worst.error);
  EXPECT_NEAR(wider.predicted_worst_error,
              2.0 * plain.predicted_worst_error,
              1e-9 * plain.predicted_worst_error);
  EXPECT_EQ(wider.T_camera_board.matrix(), plain.T_camera_board.matrix());
}

TEST(ProposeNextPose, CountsPixelsWhereToldTo) {
  GuidanceOptions options;
  options.enough.tolerance = {1.0, ErrorUnit::kPixels, 1.0, 5.0};
  const NextPose next = Propose(Samples(6), options);
  EXPECT_GT(next.worst.error, 0.1);
  EXPECT_LT(next.worst.error, 10.0);
  EXPECT_LT(next.predicted_worst_error, next.worst.error);
}

TEST(ProposeNextPose, IsTheSameEachTime) {
  const std::vector<BoardSample> samples = Samples(5);
  EXPECT_EQ(Propose(samples).T_camera_board.matrix(), Propose(samples).T_camera_board.matrix());
}

TEST(ProposeNextPose, SaysWhenNothingIsInBothViews) {
  GuidanceOptions options;
  options.sensors.min_elevation_rad = 0.6;  // the lidar looks over the camera's image
  options.sensors.max_elevation_rad = 0.9;
  const NextPose next = Propose({}, options);
  EXPECT_EQ(next.problem,
            "nowhere can the board be held: of 125 places 125 are not wholly in the view of camera "
            "and lidar within the limits");
  EXPECT_EQ(next.advice, "");
  EXPECT_TRUE(std::isnan(next.predicted_worst_error));
}

TEST(ProposeNextPose, SaysWhenTheLidarHasTooFewRows) {
  GuidanceOptions options;
  options.limits.min_rows = 100;
  EXPECT_THAT(Propose({}, options).problem, HasSubstr("where the lidar has fewer than 100 rows"));
  EXPECT_THAT(Propose({}, options).problem, Not(HasSubstr("sample")));
}

// At one distance, samples everywhere: nothing is new. What there is may still be enough.
TEST(ProposeNextPose, SaysWhenEveryPlaceIsLikeASample) {
  GuidanceOptions options;
  options.limits.min_distance_m = options.limits.max_distance_m = 2.5;
  options.limits.max_incidence_rad = 7 * M_PI / 180.0;  // no tilt makes it new
  options.enough.tolerance.tolerance = 1000.0;
  std::vector<BoardSample> samples;
  for (int column = 0; column < 16; ++column) {
    for (int row = 0; row < 10; ++row) {
      const Placement placement{{60.0 + 120.0 * column, 60.0 + 120.0 * row}, 2.5, 0.0, 0.0};
      samples.push_back(ExpectedSample(
          *PoseOf(placement, test::TestCamera(), test::TestExtrinsic().linear().col(2)),
          test::TestExtrinsic(),
          test::TestBoard(),
          test::TestCamera(),
          {}));
    }
  }
  const NextPose next = Propose(samples, options);
  EXPECT_THAT(next.problem, HasSubstr("are like a sample's"));
  EXPECT_TRUE(std::isnan(next.predicted_worst_error));
  EXPECT_TRUE(next.is_enough);
  EXPECT_THAT(next.advice, StartsWith("Enough: "));
}

// The lidar's z is the camera's: it tells no direction of the image.
TEST(ProposeNextPose, HasAPoseWhereTheLidarLooksAlongTheCamerasAxis) {
  GuidanceState state;
  ExtrinsicBelief belief;  // lidar z along camera z
  belief.T_camera_lidar.translation() = Eigen::Vector3d(0.1, 0.0, 0.0);
  state.belief = belief;
  GuidanceOptions options;
  options.sensors.min_elevation_rad = 40 * M_PI / 180.0;
  options.sensors.max_elevation_rad = 90 * M_PI / 180.0;
  options.sensors.num_rows = 24;
  options.limits.min_rows = 3;
  const NextPose next = ProposeNextPose(state, TestGuidedRig(), options);
  EXPECT_EQ(next.problem, "");
  EXPECT_TRUE(next.T_camera_board.matrix().allFinite());
  EXPECT_THAT(next.advice, HasSubstr("Hold it as a diamond"));
}

TEST(ProposeNextPose, RefusesBadOptions) {
  GuidanceOptions options;
  options.limits.min_rows = -1;
  EXPECT_EQ(options.Problems().size(), 1u);
  EXPECT_THROW(Propose({}, options), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
