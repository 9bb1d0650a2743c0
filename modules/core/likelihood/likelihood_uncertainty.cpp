#include "core/likelihood/likelihood_uncertainty.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace voqcal {
namespace {

// The variance of Student's t over the normal's: few poses measure their own variety badly, and
// about three of them hold the extrinsic; the likelihood's noise levels are of as few. Six poses,
// 3; ten, 1.4; thirty, 1.08.
double FewPosesFactor(double num_poses) {
  constexpr double kLeastFreedom = 2.5;
  const double freedom = std::max(num_poses - 3.0, kLeastFreedom);
  return freedom / (freedom - 2.0);
}

Vector6d Resampled(const LikelihoodSearch& search,
                   const SharedEquations& equations,
                   const Eigen::MatrixXd& gain) {
  const auto num_poses = static_cast<Eigen::Index>(equations.poses.size());
  Eigen::Matrix<double, 6, Eigen::Dynamic> steps(6, num_poses);
  for (Eigen::Index i = 0; i < num_poses; ++i) {
    const PoseShare& out = equations.poses[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd gain_without = search.Gain(equations.information - out.information);
    steps.col(i) = gain_without.topRows<kExtrinsicSize>() * (equations.pull - out.pull);
  }
  const double num = static_cast<double>(num_poses);
  Vector6d variance =
      (num - 1.0) / num * (steps.colwise() - steps.rowwise().mean()).rowwise().squaredNorm();
  // What poses do not tell: how far the faults are from their priors' middle.
  for (Eigen::Index i = 0; i < search.state().faults.size(); ++i) {
    const Eigen::Index fault = kExtrinsicSize + i;
    const double information = search.prior_information()[i];
    const Eigen::VectorXd shift = search.IsFree(i) ? Eigen::VectorXd(information * gain.col(fault))
                                                   : gain * equations.information.col(fault);
    variance += shift.head<kExtrinsicSize>().cwiseAbs2() / information;
  }
  return variance.cwiseSqrt();
}

}  // namespace

LikelihoodUncertainty UncertaintyOf(const LikelihoodSearch& search,
                                    const SharedEquations& equations) {
  const Eigen::MatrixXd gain = search.Gain(equations.information);
  const Matrix6d of_extrinsic = search.Covariance(equations).topLeftCorner<6, 6>();
  LikelihoodUncertainty uncertainty;
  const double few = std::sqrt(FewPosesFactor(static_cast<double>(search.poses().size())));
  uncertainty.by_likelihood = of_extrinsic.diagonal().cwiseSqrt();
  uncertainty.by_resampling = few * Resampled(search, equations, gain);
  const Vector6d widened = (few * uncertainty.by_likelihood)
                               .cwiseMax(uncertainty.by_resampling)
                               .cwiseQuotient(uncertainty.by_likelihood);
  uncertainty.covariance = widened.asDiagonal() * of_extrinsic * widened.asDiagonal();
  return uncertainty;
}

}  // namespace voqcal
