#include "core/lens_calibration/lens_covariance.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace voqcal {
namespace {

/// Inverse of a positive matrix whose rows have different units; infinite if it has none.
Eigen::MatrixXd InverseOrInfinite(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * A *
                                                             scale.asDiagonal());
  if (!(eigen.eigenvalues()(0) > 1e-13)) {
    return Eigen::MatrixXd::Constant(A.rows(), A.cols(), HUGE_VAL);
  }
  return scale.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose() *
         scale.asDiagonal();
}

}  // namespace

ViewInformation InformationOf(const ViewErrors& errors,
                              const std::vector<double>& lens,
                              const Vector6d& pose,
                              int num_parameters) {
  const auto num_rows = static_cast<Eigen::Index>(errors.num_residuals());
  Eigen::VectorXd r(num_rows);
  RowMajorXd J_lens(num_rows, static_cast<Eigen::Index>(lens.size()));
  RowMajorXd J_pose(num_rows, 6);
  const double* parameters[] = {lens.data(), pose.data()};
  double* jacobians[] = {J_lens.data(), J_pose.data()};
  errors.Evaluate(parameters, r.data(), jacobians);
  const Eigen::MatrixXd Jl = J_lens.leftCols(num_parameters);
  const Eigen::MatrixXd cross = J_pose.transpose() * Jl;
  const Matrix6d pose_information = J_pose.transpose() * J_pose;
  return {Jl.transpose() * Jl - cross.transpose() * pose_information.ldlt().solve(cross),
          Jl.transpose() * r,
          Jl};
}

Eigen::MatrixXd LensCovariance(const std::vector<ViewInformation>& views,
                               double coefficient_information,
                               double sum_px2,
                               std::size_t num_corners) {
  const Eigen::Index num_parameters = views[0].A.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(num_parameters, num_parameters);
  A.diagonal().tail(num_parameters - kNumFocal).setConstant(coefficient_information);
  for (const ViewInformation& view : views) A += view.A;
  const double dof = 2.0 * static_cast<double>(num_corners) -
                     6.0 * static_cast<double>(views.size()) - static_cast<double>(num_parameters);
  const double variance_px2 = sum_px2 / std::max(1.0, dof);
  const Eigen::MatrixXd inverse = InverseOrInfinite(A);
  if (!inverse.allFinite()) return inverse;
  double pulls_px2 = 0;
  auto num_free = static_cast<double>(num_parameters);
  for (const ViewInformation& view : views) {
    const Eigen::MatrixXd share = inverse * view.A;
    pulls_px2 += view.u.dot(inverse * view.u);
    num_free -= (share * share).trace();
  }
  const double ratio = pulls_px2 / std::max(1e-300, variance_px2 * num_free);
  return variance_px2 * std::max(1.0, ratio) * inverse;
}

Eigen::Matrix3d ScaleAndShiftCovariance(const std::vector<ViewInformation>& informations,
                                        const std::vector<LensView>& views,
                                        const Eigen::MatrixXd& covariance) {
  if (!covariance.allFinite()) return Eigen::Matrix3d::Constant(HUGE_VAL);
  std::vector<Eigen::Vector2d> seen_px;
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  for (const LensView& view : views) {
    for (const Eigen::Vector2d& corner_px : view.corners_px) {
      if (!corner_px.allFinite()) continue;
      seen_px.push_back(corner_px);
      middle_px += corner_px;
    }
  }
  middle_px /= static_cast<double>(seen_px.size());
  Eigen::Matrix3d XX = Eigen::Matrix3d::Zero();
  Eigen::MatrixXd XJ = Eigen::MatrixXd::Zero(3, covariance.rows());
  std::size_t i = 0;
  for (const ViewInformation& view : informations) {
    for (Eigen::Index row = 0; row < view.J.rows(); row += 2, ++i) {
      Eigen::Matrix<double, 2, 3> X;
      X << seen_px[i] - middle_px, Eigen::Matrix2d::Identity();
      XX += X.transpose() * X;
      XJ += X.transpose() * view.J.middleRows<2>(row);
    }
  }
  const Eigen::MatrixXd M = XX.ldlt().solve(XJ);
  return M * covariance * M.transpose();
}

}  // namespace voqcal
