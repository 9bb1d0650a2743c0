#include "core/guidance/best_design.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

namespace voqcal {
namespace {

constexpr int kMaxUpdates = 2000;
constexpr double kSmallGap = 0.01;  // of the worst error
constexpr double kNorm = 24.0;      // p: of equal squares the norm is a few percent too large

// Each candidate's matrix as a column, so that all traces are one product.
Eigen::MatrixXd Columns(const std::vector<Eigen::MatrixXd>& matrices) {
  Eigen::MatrixXd columns(matrices.front().size(), static_cast<Eigen::Index>(matrices.size()));
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = matrices[i].reshaped();
  }
  return columns;
}

// What the scene says of a covariance of the extrinsic.
struct SceneSquares {
  double worst = 0.0;                   // the largest mean square
  Matrix6d mixture = Matrix6d::Zero();  // of the forms, by their shares in the p-norm's gradient
};

SceneSquares SquaresOver(const Matrix6d& covariance, const std::vector<Matrix6d>& forms) {
  std::vector<double> squares;
  for (const Matrix6d& form : forms) squares.push_back(form.cwiseProduct(covariance).sum());
  SceneSquares judged;
  judged.worst = *std::max_element(squares.begin(), squares.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const double share = std::pow(squares[i] / judged.worst, kNorm - 1.0);
    judged.mixture += share * forms[i];
    sum += share;
  }
  judged.mixture /= sum;
  return judged;
}

}  // namespace

Design BestDesign(const Eigen::MatrixXd& known,
                  const std::vector<Eigen::MatrixXd>& candidates,
                  const std::vector<Matrix6d>& forms,
                  double num_poses) {
  if (candidates.empty() || forms.empty() || !(num_poses > 0)) {
    throw std::invalid_argument("BestDesign: needs candidates, forms and a number of poses");
  }
  const Eigen::Index size = known.rows();
  const Eigen::MatrixXd columns = Columns(candidates);
  const Eigen::MatrixXd extrinsic = Eigen::MatrixXd::Identity(size, 6);
  Eigen::VectorXd times =
      Eigen::VectorXd::Constant(columns.cols(), num_poses / static_cast<double>(columns.cols()));
  Design design;
  for (int i = 0; i < kMaxUpdates; ++i) {
    const Eigen::MatrixXd information = known + (columns * times).reshaped(size, size);
    const Eigen::MatrixXd gain = information.llt().solve(extrinsic);
    const Matrix6d covariance = gain.topRows<6>();
    const SceneSquares squares = SquaresOver(covariance, forms);
    // How fast the mixture's mean square falls with each candidate's times.
    const Eigen::MatrixXd slope = gain * squares.mixture * gain.transpose();
    const Eigen::VectorXd falls = columns.transpose() * slope.reshaped();
    const double mixture_square = squares.mixture.cwiseProduct(covariance).sum();
    // Convex: it lies above its tangent, and a mixture of squares below their largest.
    const double least_square = mixture_square - num_poses * falls.maxCoeff() + times.dot(falls);
    design.least_error = std::max(design.least_error, std::sqrt(std::max(least_square, 0.0)));
    const double worst_error = std::sqrt(squares.worst);
    if (i == 0 || worst_error < design.worst_error) {
      design.worst_error = worst_error;
      design.times = times;
    }
    if (design.worst_error - design.least_error < kSmallGap * design.worst_error) break;
    times = times.cwiseProduct((falls / falls.maxCoeff()).cwiseSqrt());
    times *= num_poses / times.sum();
  }
  return design;
}

}  // namespace voqcal
