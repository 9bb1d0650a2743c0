#include "core/sensor_network/network_fit.hpp"

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/estimation/left_perturbation.hpp"

namespace voqcal {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;
using Eigen::Index;

// From the reference outwards along the tree.
Poses PosesAlongTree(const NumberedPairs& numbered, const PairGraph& graph) {
  Poses poses(numbered.num_sensors, Eigen::Isometry3d::Identity());
  std::vector<bool> is_known(numbered.num_sensors, false);
  is_known[numbered.reference] = true;
  for (const std::size_t l : graph.tree_links) {
    const PairLink& link = numbered.links[l];
    const Eigen::Isometry3d& T_to_from = numbered.pairs[l].T_to_from;
    if (is_known[link.to]) {
      poses[link.from] = poses[link.to] * T_to_from;
    } else {
      poses[link.to] = poses[link.from] * T_to_from.inverse(Eigen::Isometry);
    }
    is_known[link.from] = is_known[link.to] = true;
  }
  return poses;
}

// A sensor's first row in the equations, which leave the reference out; -1 for that.
Index RowOf(std::size_t sensor, const NumberedPairs& numbered) {
  if (sensor == numbered.reference) return -1;
  return 6 * static_cast<Index>(sensor < numbered.reference ? sensor : sensor - 1);
}

// Gauss-Newton's equations about poses.
struct NetworkEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
  double cost = 0.0;

  void Add(const std::array<Index, 2>& rows,
           const std::array<Matrix6d, 2>& J,
           const Matrix6d& weight,
           const Vector6d& r) {
    cost += r.dot(weight * r);
    for (std::size_t a = 0; a < 2; ++a) {
      if (rows[a] < 0) continue;
      pull.segment<6>(rows[a]) -= J[a].transpose() * (weight * r);
      for (std::size_t b = 0; b < 2; ++b) {
        if (rows[b] < 0) continue;
        information.block<6, 6>(rows[a], rows[b]) += J[a].transpose() * weight * J[b];
      }
    }
  }
};

NetworkEquations EquationsAt(const Poses& poses,
                             const NumberedPairs& numbered,
                             const std::vector<Matrix6d>& weights) {
  const Index size = 6 * static_cast<Index>(numbered.num_sensors - 1);
  NetworkEquations equations{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t l = 0; l < numbered.links.size(); ++l) {
    const PairLink& link = numbered.links[l];
    const RelativePose relative(poses[link.from], poses[link.to]);
    const Vector6d r = DifferenceLeft(relative.T_to_from, numbered.pairs[l].T_to_from);
    Matrix6d J_difference = -Matrix6d::Identity();
    J_difference.topLeftCorner<3, 3>() = -LeftJacobianSO3(-r.head<3>()).inverse();
    equations.Add({RowOf(link.from, numbered), RowOf(link.to, numbered)},
                  {J_difference * relative.J_from, J_difference * relative.J_to},
                  weights[l],
                  r);
  }
  return equations;
}

Poses Moved(const Poses& poses, const NumberedPairs& numbered, const Eigen::VectorXd& step) {
  Poses moved = poses;
  for (std::size_t sensor = 0; sensor < poses.size(); ++sensor) {
    const Index row = RowOf(sensor, numbered);
    if (row >= 0) moved[sensor] = PerturbLeft(poses[sensor], step.segment<6>(row));
  }
  return moved;
}

// With the reference's rows, which are zero.
Eigen::MatrixXd WholeCovariance(const Eigen::MatrixXd& information, const NumberedPairs& numbered) {
  const Eigen::MatrixXd inverse =
      information.llt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  const Index size = 6 * static_cast<Index>(numbered.num_sensors);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t a = 0; a < numbered.num_sensors; ++a) {
    for (std::size_t b = 0; b < numbered.num_sensors; ++b) {
      const Index row = RowOf(a, numbered);
      const Index column = RowOf(b, numbered);
      if (row < 0 || column < 0) continue;
      covariance.block<6, 6>(6 * static_cast<Index>(a), 6 * static_cast<Index>(b)) =
          inverse.block<6, 6>(row, column);
    }
  }
  return covariance;
}

}  // namespace

NumberedPairs NumberedPairs::Without(std::size_t pair) const {
  NumberedPairs others = *this;
  others.links.erase(others.links.begin() + static_cast<std::ptrdiff_t>(pair));
  others.pairs.erase(others.pairs.begin() + static_cast<std::ptrdiff_t>(pair));
  return others;
}

SensorPair NetworkFit::Between(std::size_t from, std::size_t to) const {
  const RelativePose relative(T_reference_sensor[from], T_reference_sensor[to]);
  const auto block = [this](std::size_t a, std::size_t b) -> Matrix6d {
    return covariance.block<6, 6>(6 * static_cast<Index>(a), 6 * static_cast<Index>(b));
  };
  SensorPair pair;
  pair.T_to_from = relative.T_to_from;
  const Matrix6d cross = relative.J_from * block(from, to) * relative.J_to.transpose();
  pair.covariance = relative.J_from * block(from, from) * relative.J_from.transpose() +
                    relative.J_to * block(to, to) * relative.J_to.transpose() + cross +
                    cross.transpose();
  return pair;
}

NetworkFit FitNetwork(const NumberedPairs& numbered, const PairGraph& graph) {
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-11;  // radians and metres
  constexpr double kLeastShare = 1e-6;  // of a step that must be cut to go downhill
  std::vector<Matrix6d> weights;
  for (std::size_t l = 0; l < numbered.pairs.size(); ++l) {
    weights.push_back(graph.tree_share[l] *
                      numbered.pairs[l].covariance.llt().solve(Matrix6d::Identity()));
  }
  NetworkFit fit;
  fit.T_reference_sensor = PosesAlongTree(numbered, graph);
  NetworkEquations equations = EquationsAt(fit.T_reference_sensor, numbered, weights);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::VectorXd step = equations.information.llt().solve(equations.pull);
    if (step.norm() < kConverged) break;
    // Whole, or cut until it goes downhill: a wrong pair may bend the way.
    double share = 1.0;
    Poses moved;
    NetworkEquations there;
    do {
      moved = Moved(fit.T_reference_sensor, numbered, share * step);
      there = EquationsAt(moved, numbered, weights);
      share /= 2;
    } while (there.cost > equations.cost && share > kLeastShare);
    if (there.cost > equations.cost) break;  // rounding allows no better
    fit.T_reference_sensor = moved;
    equations = there;
  }
  fit.covariance = WholeCovariance(equations.information, numbered);
  return fit;
}

}  // namespace voqcal
