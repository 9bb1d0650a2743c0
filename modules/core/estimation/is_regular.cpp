#include "core/estimation/is_regular.hpp"

#include <Eigen/Eigenvalues>

namespace voqcal {

bool IsRegular(const Eigen::MatrixXd& information) {
  constexpr double kLeastReciprocalCondition = 1e-9;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  return eigenvalues[0] > kLeastReciprocalCondition * eigenvalues[eigenvalues.size() - 1];
}

}  // namespace voqcal
