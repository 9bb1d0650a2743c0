#include "core/selection/voq.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <Eigen/SVD>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// By the singular values: ||N||_F^2 is the sum of their squares, ||N^-1||_F^2 of their inverses'.
double ConditionBySvd(const Eigen::Vector3d& n0,
                      const Eigen::Vector3d& n1,
                      const Eigen::Vector3d& n2) {
  Eigen::Matrix3d N;
  N << n0.transpose(), n1.transpose(), n2.transpose();
  const Eigen::Vector3d s = Eigen::JacobiSVD<Eigen::Matrix3d>(N).singularValues();
  return s.norm() * s.cwiseInverse().norm();
}

std::vector<VoqSet> BruteForce(const std::vector<BoardSample>& samples, int num_sets) {
  const BoardSpec board = test::TestBoard();
  std::vector<VoqSet> sets;
  const int n = static_cast<int>(samples.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        const BoardSample& a = samples[i];
        const BoardSample& b = samples[j];
        const BoardSample& c = samples[k];
        VoqSet set;
        set.samples = {i, j, k};
        set.kappa_lidar =
            ConditionBySvd(a.lidar.pose.normal, b.lidar.pose.normal, c.lidar.pose.normal);
        set.kappa_camera =
            ConditionBySvd(a.camera.pose.normal, b.camera.pose.normal, c.camera.pose.normal);
        set.board_error_mm = (BoardDimensionErrorMm(a.lidar.edge_lengths_m, board) +
                              BoardDimensionErrorMm(b.lidar.edge_lengths_m, board) +
                              BoardDimensionErrorMm(c.lidar.edge_lengths_m, board)) /
                             3.0;
        set.voq = std::max(set.kappa_lidar, set.kappa_camera) + set.board_error_mm;
        sets.push_back(set);
      }
    }
  }
  std::sort(sets.begin(), sets.end(), [](const VoqSet& a, const VoqSet& b) {
    return std::tie(a.voq, a.samples) < std::tie(b.voq, b.samples);
  });
  sets.resize(std::min<std::size_t>(sets.size(), static_cast<std::size_t>(num_sets)));
  return sets;
}

std::vector<BoardSample> NoisySamples(int num_samples, double edge_noise_m, std::uint32_t seed) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.edge_noise_m = edge_noise_m;
  scene.lidar_rotation_noise_rad = 0.02;
  scene.seed = seed;
  return test::SynthesizeSamples(scene);
}

TEST(NormalConditionNumber, OfManyNormalsIsTheSameForThreeRepeated) {
  test::Random random(4);
  std::vector<Eigen::Vector3d> normals;
  for (int i = 0; i < 3; ++i) normals.push_back(random.NormalVector().normalized());
  std::vector<Eigen::Vector3d> twice = normals;
  twice.insert(twice.end(), normals.begin(), normals.end());
  // Each singular value grows by sqrt(2), and each inverse shrinks by it.
  const double kappa = ConditionBySvd(normals[0], normals[1], normals[2]);
  EXPECT_NEAR(NormalConditionNumber(normals), kappa, 1e-12 * kappa * kappa);
  EXPECT_NEAR(NormalConditionNumber(twice), kappa, 1e-12 * kappa * kappa);
}

TEST(MedianBoardDimensionErrorMm, LeavesOutWhatWasNotMeasured) {
  std::vector<BoardSample> samples(5);
  const BoardSpec board = test::TestBoard();
  for (std::size_t i = 0; i < 4; ++i) {
    samples[i].lidar.edge_lengths_m = board.EdgeLengthsM();
    samples[i].lidar.edge_lengths_m[i] += 0.001 * static_cast<double>(i + 1);
  }
  samples[4].lidar.edge_lengths_m.fill(NAN);
  EXPECT_NEAR(MedianBoardDimensionErrorMm(samples, board), 2.5, 1e-9);
  samples.erase(samples.begin());
  EXPECT_NEAR(MedianBoardDimensionErrorMm(samples, board), 3.0, 1e-9);
  EXPECT_TRUE(std::isnan(MedianBoardDimensionErrorMm({}, board)));
}

TEST(BoardDimensionErrorMm, SumsTheFourEdges) {
  EXPECT_NEAR(BoardDimensionErrorMm({0.62, 0.84, 0.605, 0.85}, test::TestBoard()), 25.0, 1e-9);
}

TEST(BoardDimensionErrorMm, TakesOpenEdgesToErrAsTheOthersDo) {
  EXPECT_NEAR(BoardDimensionErrorMm({NAN, 0.84, NAN, 0.85}, test::TestBoard()), 20.0, 1e-9);
  EXPECT_TRUE(std::isnan(BoardDimensionErrorMm({NAN, NAN, NAN, NAN}, test::TestBoard())));
}

TEST(NormalConditionNumber, IsThreeForOrthogonalNormals) {
  EXPECT_DOUBLE_EQ(
      NormalConditionNumber(
          Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY()),
      3.0);
}

TEST(NormalConditionNumber, AgreesWithSingularValues) {
  test::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d n0 = random.NormalVector().normalized();
    const Eigen::Vector3d n1 = (n0 + 0.3 * random.NormalVector()).normalized();
    const Eigen::Vector3d n2 = (n0 + 0.3 * random.NormalVector()).normalized();
    const double expected = ConditionBySvd(n0, n1, n2);
    // The determinant's rounding, 1e-16, weighs kappa times.
    EXPECT_NEAR(NormalConditionNumber(n0, n1, n2), expected, 1e-14 * expected * expected);
  }
}

TEST(NormalConditionNumber, IsInfiniteForDependentNormals) {
  const Eigen::Vector3d n = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Vector3d m = Eigen::Vector3d(1, 0, 3).normalized();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(NormalConditionNumber(n, n, m), infinity);
  EXPECT_EQ(NormalConditionNumber(n, m, (n + m).normalized()), infinity);
}

TEST(SelectByVoq, AgreesWithBruteForce) {
  for (const double edge_noise_m : {0.0, 0.0003, 0.003, 0.03}) {
    for (const int num_sets : {1, 50, 100000}) {
      const auto samples = NoisySamples(14, edge_noise_m, 7);
      const auto expected = BruteForce(samples, num_sets);
      const auto sets = SelectByVoq(samples, test::TestBoard(), num_sets);
      ASSERT_EQ(sets.size(), expected.size());
      for (std::size_t i = 0; i < sets.size(); ++i) {
        EXPECT_EQ(sets[i].samples, expected[i].samples) << i;
        EXPECT_NEAR(sets[i].kappa_lidar, expected[i].kappa_lidar, 1e-9 * expected[i].kappa_lidar);
        EXPECT_NEAR(
            sets[i].kappa_camera, expected[i].kappa_camera, 1e-9 * expected[i].kappa_camera);
        EXPECT_DOUBLE_EQ(sets[i].board_error_mm, expected[i].board_error_mm);
      }
    }
  }
}

TEST(SelectByVoq, BreaksTiesByIndex) {
  // Four times the same three poses: every combination of different ones ties exactly.
  const auto three = NoisySamples(3, 0.0, 1);
  std::vector<BoardSample> samples;
  for (int i = 0; i < 4; ++i) samples.insert(samples.end(), three.begin(), three.end());
  const auto sets = SelectByVoq(samples, test::TestBoard(), 64);
  ASSERT_EQ(sets.size(), 64u);
  EXPECT_THAT(sets[0].samples, ElementsAre(0, 1, 2));
  for (std::size_t i = 1; i < sets.size(); ++i) {
    EXPECT_LE(sets[i - 1].voq, sets[i].voq);
    if (sets[i - 1].voq == sets[i].voq) {
      EXPECT_LT(sets[i - 1].samples, sets[i].samples);
    }
  }
}

TEST(SelectByVoq, FindsNoSetInTwoSamples) {
  EXPECT_THAT(SelectByVoq(NoisySamples(2, 0.0, 1), test::TestBoard(), 50), IsEmpty());
  EXPECT_THAT(SelectByVoq({}, test::TestBoard(), 50), IsEmpty());
}

TEST(SelectByVoq, LeavesOutParallelNormals) {
  auto samples = NoisySamples(4, 0.0, 1);
  samples[1].lidar.pose.normal = samples[0].lidar.pose.normal;
  const auto sets = SelectByVoq(samples, test::TestBoard(), 50);
  ASSERT_EQ(sets.size(), 2u);  // of four, those without both 0 and 1
  for (const VoqSet& set : sets) EXPECT_FALSE(set.samples[0] == 0 && set.samples[1] == 1);
}

TEST(SelectByVoq, CountsAnOpenEdgeAsFiftyMillimetres) {
  auto samples = NoisySamples(4, 0.0, 1);
  samples[2].lidar.edge_lengths_m[1] = std::numeric_limits<double>::quiet_NaN();
  const auto sets = SelectByVoq(samples, test::TestBoard(), 50);
  ASSERT_EQ(sets.size(), 4u);
  for (const VoqSet& set : sets) {
    const bool is_whole = std::count(set.samples.begin(), set.samples.end(), 2) == 0;
    EXPECT_NEAR(set.board_error_mm, is_whole ? 0.0 : 50.0 / 3, 1e-6);
    EXPECT_NEAR(set.voq, std::max(set.kappa_lidar, set.kappa_camera) + set.board_error_mm, 1e-9);
  }
}

TEST(SelectByVoq, RefusesNoSets) {
  EXPECT_THROW(SelectByVoq({}, test::TestBoard(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
