#include "core/likelihood/consider_covariance.hpp"

#include <Eigen/Cholesky>

namespace voqcal {
namespace {

// Where the i-th fault is among the unknowns.
Eigen::Index FaultIndex(const Eigen::MatrixXd& information,
                        const std::vector<bool>& is_free,
                        std::size_t i) {
  return information.rows() - static_cast<Eigen::Index>(is_free.size() - i);
}

}  // namespace

Eigen::MatrixXd GainWithHeld(const Eigen::MatrixXd& information, const std::vector<bool>& is_free) {
  Eigen::MatrixXd of_free = information;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) continue;
    const Eigen::Index held = FaultIndex(information, is_free, i);
    of_free.row(held).setZero();
    of_free.col(held).setZero();
    of_free(held, held) = 1.0;
  }
  Eigen::MatrixXd gain =
      of_free.ldlt().solve(Eigen::MatrixXd::Identity(of_free.rows(), of_free.cols()));
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    const Eigen::Index held = FaultIndex(information, is_free, i);
    if (!is_free[i]) gain(held, held) = 0.0;
  }
  return gain;
}

Eigen::MatrixXd ConsiderCovariance(const Eigen::MatrixXd& information,
                                   const Eigen::VectorXd& prior_information,
                                   const std::vector<bool>& is_free) {
  const Eigen::MatrixXd gain = GainWithHeld(information, is_free);
  Eigen::MatrixXd covariance = gain;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) continue;
    const Eigen::Index held = FaultIndex(information, is_free, i);
    const double variance_m2 = 1.0 / prior_information[static_cast<Eigen::Index>(i)];
    const Eigen::VectorXd shift = gain * information.col(held);
    covariance += variance_m2 * shift * shift.transpose();
    covariance(held, held) = variance_m2;
  }
  return covariance;
}

}  // namespace voqcal
