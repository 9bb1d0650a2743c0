#include "core/selection/differences_from_others.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kNoise = 0.005;  // radians and metres

std::vector<BoardSample> Session(int num_samples, std::uint32_t seed = 1) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = kNoise;
  scene.lidar_centre_noise_m = kNoise;
  scene.seed = seed;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    sample.lidar.pose.covariance = kNoise * kNoise * Matrix6d::Identity();
  }
  return samples;
}

std::vector<std::int64_t> IdsOf(const std::vector<SampleDifference>& differences) {
  std::vector<std::int64_t> ids;
  for (const SampleDifference& each : differences) ids.push_back(each.id);
  return ids;
}

std::vector<std::int64_t> OutlyingIds(const std::vector<BoardSample>& samples) {
  return IdsOf(FindOutlying(test::Pointers(samples), test::TestCamera()));
}

TEST(DifferencesFromOthers, FindsTheSampleThatIsWrong) {
  std::vector<BoardSample> samples = Session(12);
  samples[3].lidar.pose.centre_m.x() += 0.1;
  const auto differences = DifferencesFromOthers(test::Pointers(samples), test::TestCamera());
  ASSERT_EQ(differences.size(), 12u);
  for (const SampleDifference& each : differences) {
    EXPECT_EQ(each.IsWrong(), each.id == samples[3].id) << each.id << ' ' << each.sigmas;
  }
}

TEST(FindOutlying, FindsWhatAllOthersContradict) {
  // 60 mm and 4.6 degrees: no more than FindConsistent, pair by pair, allows.
  std::vector<BoardSample> samples = Session(12);
  samples[3].lidar.pose.centre_m.x() += 0.06;
  const Eigen::Matrix3d turn = ExpSO3({0, 0.08, 0});
  BoardPose& tilted = samples[7].lidar.pose;
  tilted.normal = turn * tilted.normal;
  for (Eigen::Vector3d& corner_m : tilted.corners_m) {
    corner_m = tilted.centre_m + turn * (corner_m - tilted.centre_m);
  }
  std::vector<std::int64_t> ids = OutlyingIds(samples);
  std::sort(ids.begin(), ids.end());
  EXPECT_THAT(ids, ElementsAre(samples[3].id, samples[7].id));
}

TEST(FindOutlying, SeldomTakesARightSampleForWrong) {
  constexpr int kRuns = 20;
  std::size_t num_taken = 0;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed)
    num_taken += OutlyingIds(Session(12, seed)).size();
  // 0.27 % of 240 are expected by chance.
  EXPECT_LE(num_taken, 3u);
}

TEST(FindOutlying, FindsNoneWhereAllAreBad) {
  std::vector<BoardSample> samples = Session(12);
  for (BoardSample& sample : samples) sample.lidar.pose.covariance /= 25.0;
  EXPECT_THAT(OutlyingIds(samples), IsEmpty());
}

TEST(FindOutlying, LeavesFewSamplesAlone) {
  std::vector<BoardSample> samples = Session(7);
  samples[3].lidar.pose.centre_m.x() += 0.1;
  EXPECT_THAT(OutlyingIds(samples), IsEmpty());
}

TEST(ReasonFor, SaysHowFar) {
  SampleDifference difference;
  difference.r << 0, 0.01, 0, 0.03, 0, 0.04;
  difference.sigmas = 5.12;
  EXPECT_EQ(ReasonFor(difference),
            "is off by 50.0 mm and 0.57 deg from where all the others put it: 5.1 sigma");
}

}  // namespace
}  // namespace voqcal
