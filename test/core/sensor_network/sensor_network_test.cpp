#include "core/sensor_network/sensor_network.hpp"

#include <cmath>
#include <map>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>

#include "core/units.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

const std::vector<std::string> kFive = {"lidar_a", "lidar_b", "front", "left", "rear"};

/// A rig with its truth; pairs are made from it.
class Rigged {
 public:
  Rigged(const std::vector<std::string>& sensors, std::uint32_t seed)
      : sensors_(sensors), random_(seed) {
    for (const std::string& sensor : sensors) {
      T_world_[sensor] = Eigen::Isometry3d::Identity();
      T_world_[sensor].linear() = ExpSO3(random_.NormalVector());
      T_world_[sensor].translation() = 0.5 * random_.NormalVector();
    }
  }

  const std::vector<std::string>& sensors() const { return sensors_; }

  Eigen::Isometry3d Truth(const std::string& from, const std::string& to) const {
    return T_world_.at(to).inverse() * T_world_.at(from);
  }

  /// The true pair, with a covariance of `scale` times about 0.02 degrees and 1 mm.
  SensorPair Exact(const std::string& from, const std::string& to, double scale = 1.0) {
    Matrix6d root;
    for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random_.Normal();
    const Matrix6d mixed = 0.2 * root * root.transpose() + Matrix6d::Identity();
    Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(3e-4), Eigen::Vector3d::Constant(1e-3);
    const Matrix6d C = scale * scale * sigma.asDiagonal() * mixed * sigma.asDiagonal();
    return {from, to, Truth(from, to), 0.5 * (C + C.transpose())};
  }

  /// With an error that the covariance allows.
  SensorPair Noisy(const std::string& from, const std::string& to) {
    SensorPair pair = Exact(from, to);
    Vector6d white;
    white << random_.NormalVector(), random_.NormalVector();
    const Matrix6d root = pair.covariance.llt().matrixL();
    pair.T_to_from = PerturbLeft(pair.T_to_from, root * white);
    return pair;
  }

  /// All lidars with all cameras.
  std::vector<SensorPair> AllNoisy(std::size_t num_lidars) {
    std::vector<SensorPair> pairs;
    for (std::size_t l = 0; l < num_lidars; ++l) {
      for (std::size_t c = num_lidars; c < sensors_.size(); ++c) {
        pairs.push_back(Noisy(sensors_[l], sensors_[c]));
      }
    }
    return pairs;
  }

 private:
  std::vector<std::string> sensors_;
  test::Random random_;
  std::map<std::string, Eigen::Isometry3d> T_world_;
};

TEST(JoinPairs, RecoversTheTruthFromExactPairs) {
  Rigged rig(kFive, 1);
  std::vector<SensorPair> pairs;
  for (const char* camera : {"front", "left", "rear"}) {
    pairs.push_back(rig.Exact("lidar_a", camera));
    pairs.push_back(rig.Exact(camera, "lidar_b", 3.0));
  }
  const SensorNetwork network = JoinPairs(rig.sensors(), "left", pairs);
  ASSERT_EQ(network.problem, "");
  EXPECT_EQ(network.warning, "");
  EXPECT_THAT(network.doubtful, IsEmpty());
  EXPECT_THAT(network.closures, SizeIs(6));
  for (const PairClosure& closure : network.closures) EXPECT_LT(closure.chi_square, 1e-12);
  for (std::size_t i = 0; i < kFive.size(); ++i) {
    EXPECT_THAT(network.T_reference_sensor[i],
                test::IsNear(rig.Truth(kFive[i], "left"), 1e-12, 1e-12));
  }
  EXPECT_TRUE(network.covariance.block(18, 0, 6, 30).isZero(0.0)) << "the reference's rows";
  EXPECT_THAT(network.Between("lidar_a", "lidar_b").T_to_from,
              test::IsNear(rig.Truth("lidar_a", "lidar_b"), 1e-12, 1e-12));
}

TEST(JoinPairs, LeavesAPairAloneAsItIs) {
  Rigged rig({"lidar", "camera"}, 2);
  const SensorPair pair = rig.Noisy("lidar", "camera");
  for (const char* reference : {"lidar", "camera"}) {
    const SensorNetwork network = JoinPairs(rig.sensors(), reference, {pair});
    const SensorPair joined = network.Between("lidar", "camera");
    EXPECT_EQ(joined.T_to_from.matrix(), pair.T_to_from.matrix());
    EXPECT_EQ(joined.covariance, pair.covariance);
    EXPECT_THAT(network.closures, IsEmpty());
  }
}

// The oracle: the composition of both pairs, perturbed by each in turn.
TEST(JoinPairs, ComposesTheCovarianceOfAChain) {
  Rigged rig({"front", "lidar", "rear"}, 3);
  const SensorPair first = rig.Noisy("lidar", "front");
  const SensorPair second = rig.Noisy("lidar", "rear");
  const auto composed = [&](const Vector6d& a, const Vector6d& b) -> Eigen::Isometry3d {
    return PerturbLeft(first.T_to_from, a) * PerturbLeft(second.T_to_from, b).inverse();
  };
  const Vector6d zero = Vector6d::Zero();
  Matrix6d J_first, J_second;
  for (int i = 0; i < 6; ++i) {
    constexpr double kStep = 1e-6;
    const Vector6d step = kStep * Vector6d::Unit(i);
    J_first.col(i) = DifferenceLeft(composed(-step, zero), composed(step, zero)) / (2 * kStep);
    J_second.col(i) = DifferenceLeft(composed(zero, -step), composed(zero, step)) / (2 * kStep);
  }
  const Matrix6d expected = J_first * first.covariance * J_first.transpose() +
                            J_second * second.covariance * J_second.transpose();
  for (const char* reference : {"front", "lidar", "rear"}) {
    const SensorNetwork network = JoinPairs(rig.sensors(), reference, {first, second});
    const SensorPair chain = network.Between("rear", "front");
    EXPECT_THAT(chain.T_to_from, test::IsNear(composed(zero, zero), 1e-12, 1e-12));
    EXPECT_LT((chain.covariance - expected).norm(), 1e-8 * expected.norm()) << reference;
  }
}

TEST(JoinPairs, IsTheSameWhicheverSensorIsTheReference) {
  Rigged rig(kFive, 4);
  const std::vector<SensorPair> pairs = rig.AllNoisy(2);
  const SensorPair expected = JoinPairs(kFive, "lidar_a", pairs).Between("rear", "front");
  for (const std::string& reference : kFive) {
    const SensorPair joined = JoinPairs(kFive, reference, pairs).Between("rear", "front");
    EXPECT_THAT(joined.T_to_from, test::IsNear(expected.T_to_from, 1e-7, 1e-7));
    EXPECT_LT((joined.covariance - expected.covariance).norm(), 1e-3 * expected.covariance.norm());
  }
}

// Errors that are the sensors' own close every loop, and no number of pairs lessens them.
TEST(JoinPairs, DoesNotTakeLoopsForNews) {
  constexpr int kDraws = 200;
  constexpr double kSigmaM = 1e-3;
  Rigged rig(kFive, 5);
  test::Random random(6);
  Matrix6d covariance = Matrix6d::Identity();
  covariance.topLeftCorner<3, 3>() *= 1e-8;  // rotations hardly err: the oracle is linear
  covariance.bottomRightCorner<3, 3>() *= 2 * kSigmaM * kSigmaM;
  double sum_squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::map<std::string, Eigen::Vector3d> own_error_m;
    for (const std::string& sensor : kFive) own_error_m[sensor] = kSigmaM * random.NormalVector();
    std::vector<SensorPair> pairs;
    for (const char* lidar : {"lidar_a", "lidar_b"}) {
      for (const char* camera : {"front", "left", "rear"}) {
        SensorPair pair{lidar, camera, rig.Truth(lidar, camera), covariance};
        pair.T_to_from.translation() +=
            own_error_m[camera] - pair.T_to_from.linear() * own_error_m[lidar];
        pairs.push_back(pair);
      }
    }
    const SensorNetwork network = JoinPairs(kFive, "lidar_a", pairs);
    for (const SensorPair& pair : pairs) {
      const SensorPair joined = network.Between(pair.from, pair.to);
      const Vector6d error = DifferenceLeft(rig.Truth(pair.from, pair.to), joined.T_to_from);
      sum_squares +=
          error.tail<3>().cwiseAbs2().cwiseQuotient(joined.covariance.diagonal().tail<3>()).mean() /
          static_cast<double>(pairs.size());
    }
  }
  // 200 draws of 12 free numbers: 1 +- 0.03 (1 sigma); allow 3 of them.
  EXPECT_NEAR(sum_squares / kDraws, 1.0, 0.09);
}

TEST(JoinPairs, LeavesOutTheOneWrongPairThatTheLoopsName) {
  Rigged rig({"lidar_a", "lidar_b", "lidar_c", "front", "left", "rear"}, 7);
  std::vector<SensorPair> pairs = rig.AllNoisy(3);
  Vector6d wrong;
  wrong << 0.5 * kRadPerDeg, 0, 0, 0, 0.02, 0;
  pairs[4].T_to_from = PerturbLeft(pairs[4].T_to_from, wrong);  // lidar_b - left
  const SensorNetwork network = JoinPairs(rig.sensors(), "lidar_a", pairs);
  ASSERT_EQ(network.problem, "");
  EXPECT_THAT(network.doubtful, ElementsAre(4));
  EXPECT_TRUE(network.is_left_out);
  EXPECT_THAT(network.warning, AllOf(HasSubstr("lidar_b - left (by 0."), HasSubstr("left out")));
  const PairClosure& closure = network.closures[4];
  EXPECT_EQ(closure.pair, 4U);
  EXPECT_TRUE(closure.Contradicts());
  EXPECT_LT((closure.difference - wrong).head<3>().norm(), 0.15 * kRadPerDeg);
  EXPECT_LT((closure.difference - wrong).tail<3>().norm(), 8e-3);
  EXPECT_THAT(network.Between("lidar_b", "left").T_to_from,
              test::IsNear(rig.Truth("lidar_b", "left"), 0.1 * kRadPerDeg, 5e-3));
}

TEST(JoinPairs, LeavesOutAPairThatIsWhollyWrong) {
  Rigged rig({"lidar_a", "lidar_b", "lidar_c", "front", "left", "rear"}, 8);
  std::vector<SensorPair> pairs = rig.AllNoisy(3);
  pairs[0].T_to_from = Eigen::Isometry3d(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitX()));
  const SensorNetwork network = JoinPairs(rig.sensors(), "lidar_a", pairs);
  EXPECT_THAT(network.doubtful, ElementsAre(0));
  EXPECT_THAT(network.Between("lidar_a", "front").T_to_from,
              test::IsNear(rig.Truth("lidar_a", "front"), 0.1 * kRadPerDeg, 5e-3));
}

// One loop cannot tell which of its pairs it is: all are named, and as uncertain as that.
TEST(JoinPairs, NamesAllThatMayBeWrong) {
  Rigged rig({"lidar_a", "lidar_b", "front", "rear"}, 9);
  std::vector<SensorPair> pairs = rig.AllNoisy(2);
  const double sigma_before_m = std::sqrt(
      JoinPairs(rig.sensors(), "lidar_a", pairs).Between("lidar_b", "rear").covariance(5, 5));
  pairs[3].T_to_from.translation().z() += 0.05;  // lidar_b - rear
  const SensorNetwork network = JoinPairs(rig.sensors(), "lidar_a", pairs);
  EXPECT_THAT(network.doubtful, UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_FALSE(network.is_left_out);
  EXPECT_THAT(network.warning, HasSubstr("cannot tell which"));
  const SensorPair joined = network.Between("lidar_b", "rear");
  EXPECT_LT(sigma_before_m, 2e-3);
  EXPECT_GT(std::sqrt(joined.covariance(5, 5)), 0.02);
}

// A camera with two pairs: either may be the wrong one, the other sensors' loops are clear.
TEST(JoinPairs, DoubtsOnlyWhatMayBeWrong) {
  Rigged rig(kFive, 12);
  std::vector<SensorPair> pairs = rig.AllNoisy(2);
  pairs[4].T_to_from.translation().x() += 0.05;  // lidar_b - left
  const SensorNetwork network = JoinPairs(kFive, "lidar_a", pairs);
  EXPECT_THAT(network.doubtful, ElementsAre(1, 4));
  EXPECT_FALSE(network.is_left_out);
  EXPECT_THAT(network.Between("front", "rear").T_to_from,
              test::IsNear(rig.Truth("front", "rear"), 0.1 * kRadPerDeg, 5e-3));
  EXPECT_LT(std::sqrt(network.Between("front", "rear").covariance(3, 3)), 3e-3);
  EXPECT_GT(std::sqrt(network.Between("lidar_b", "left").covariance(3, 3)), 0.02);
}

TEST(JoinPairs, SaysWhichSensorsToJoin) {
  Rigged rig(kFive, 10);
  const SensorNetwork network =
      JoinPairs(kFive, "lidar_a", {rig.Exact("lidar_a", "front"), rig.Exact("lidar_b", "rear")});
  EXPECT_FALSE(network.IsUsable());
  EXPECT_THAT(network.problem, HasSubstr("lidar_a, front | lidar_b, rear | left;"));
  EXPECT_THROW(network.Between("lidar_a", "front"), std::logic_error);
}

TEST(JoinPairs, RefusesWhatIsNoRig) {
  Rigged rig(kFive, 11);
  const SensorPair good = rig.Exact("lidar_a", "front");
  SensorPair unknown = good;
  unknown.to = "back";
  SensorPair itself = good;
  itself.to = "lidar_a";
  SensorPair certain = good;
  certain.covariance.setZero();
  const auto message = [](const std::vector<std::string>& sensors,
                          const std::string& reference,
                          const std::vector<SensorPair>& pairs) -> std::string {
    try {
      JoinPairs(sensors, reference, pairs);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(kFive, "lidar_a", {unknown}),
              HasSubstr("two of the sensors, is lidar_a - back"));
  EXPECT_THAT(message(kFive, "lidar_a", {itself}), HasSubstr("two different sensors"));
  EXPECT_THAT(message(kFive, "lidar_a", {good, Reversed(good)}),
              HasSubstr("given once, is front - lidar_a"));
  EXPECT_THAT(message(kFive, "lidar_a", {certain}), HasSubstr("positive definite"));
  EXPECT_THAT(message(kFive, "top", {good}), HasSubstr("reference must be a sensor, is top"));
  EXPECT_THAT(message({"lidar_a", "front", "front"}, "front", {good}),
              HasSubstr("named once, is front"));
  EXPECT_THROW(JoinPairs({"lidar_a", "front"}, "front", {good}).Between("front", "rear"),
               std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
