#include "core/assessment/fault_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "core/estimation/sighting_errors.hpp"

namespace voqcal {
namespace {

// No fit is believed to be better than this: exact data must not make noise levels of zero.
constexpr NoiseLevels kLeastNoise = {2e-4, 5e-4, 5e-4, 5e-4, 0.02};
constexpr NoiseLevels kFirstNoise = {3e-3, 1e-2, 1e-2, 5e-3, 0.3};
constexpr std::array<int, kCorner> kRowsOfKind = {2, 1, 2, 1};
// 1 sigma of the parameters that have a prior, the same as the result's: the others are free.
struct Prior {
  FaultParameter fault;
  double sigma;
};
constexpr std::array<Prior, 2> kPriors = {Prior{kChessboardTurnX, kPriorChessboardTurnRad},
                                          Prior{kChessboardTurnY, kPriorChessboardTurnRad}};
// Neighbouring corners err alike, by what no lens model has: so many tell as much as all of them.
constexpr double kIndependentCorners = 0.1;

// The columns of the model that are fitted: the extrinsic's and those of the faults.
std::vector<int> Columns(const std::vector<FaultParameter>& faults) {
  std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  for (const FaultParameter fault : faults) columns.push_back(kNumExtrinsicParameters + fault);
  return columns;
}

struct NormalEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

void Add(const FaultEquation& equation,
         const std::vector<int>& columns,
         const NoiseLevels& noise,
         double sign,
         NormalEquations* sum) {
  Eigen::MatrixXd J(6, static_cast<Eigen::Index>(columns.size()));
  Vector6d r = equation.r;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    J.col(static_cast<Eigen::Index>(i)) = equation.J.col(columns[i]);
  }
  for (int row = 0; row < 6; ++row) {
    const double sigma = noise[KindOfRow(row)];
    J.row(row) /= sigma;
    r[row] /= sigma;
  }
  sum->H += sign * J.transpose() * J;
  sum->b -= sign * J.transpose() * r;
  const double weight = sign * kIndependentCorners / (noise[kCorner] * noise[kCorner]);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    sum->b[row] += weight * equation.corners.pull[columns[i]];
    for (std::size_t k = 0; k < columns.size(); ++k) {
      sum->H(row, static_cast<Eigen::Index>(k)) +=
          weight * equation.corners.information(columns[i], columns[k]);
    }
  }
}

NormalEquations SumOf(const std::vector<FaultEquation>& equations,
                      const std::vector<int>& columns,
                      const NoiseLevels& noise) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  NormalEquations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const FaultEquation& equation : equations) Add(equation, columns, noise, 1, &sum);
  for (const Prior& prior : kPriors) {
    const auto column =
        std::find(columns.begin(), columns.end(), kNumExtrinsicParameters + prior.fault);
    if (column == columns.end()) continue;
    const Eigen::Index i = column - columns.begin();
    sum.H(i, i) += 1 / (prior.sigma * prior.sigma);
  }
  return sum;
}

// Nothing if the equations leave a parameter open. Columns are scaled to unit length first, as
// their units differ.
std::optional<Eigen::MatrixXd> InverseOf(const Eigen::MatrixXd& H) {
  constexpr double kLeastShare = 1e-9;  // of a column that is not a combination of the others
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return std::nullopt;
  const Eigen::MatrixXd unit =
      scale.cwiseInverse().asDiagonal() * H * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> solver(unit);
  if (!(solver.vectorD().minCoeff() > kLeastShare)) return std::nullopt;
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()));
  return Eigen::MatrixXd(scale.cwiseInverse().asDiagonal() * inverse *
                         scale.cwiseInverse().asDiagonal());
}

ModelVector Scattered(const Eigen::VectorXd& fitted, const std::vector<int>& columns) {
  ModelVector all = ModelVector::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all[columns[i]] = fitted[static_cast<Eigen::Index>(i)];
  }
  return all;
}

ModelMatrix Scattered(const Eigen::MatrixXd& fitted, const std::vector<int>& columns) {
  ModelMatrix all = ModelMatrix::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all.col(columns[i]) =
        Scattered(Eigen::VectorXd(fitted.col(static_cast<Eigen::Index>(i))), columns);
  }
  return all;
}

double NumRows(const FaultEquation& equation, std::size_t kind) {
  return kind == kCorner ? kIndependentCorners * equation.corners.num_rows : kRowsOfKind[kind];
}

double NumRows(const std::vector<FaultEquation>& equations, std::size_t kind) {
  double num = 0;
  for (const FaultEquation& equation : equations) num += NumRows(equation, kind);
  return num;
}

using Squares = std::array<double, kNumResidualKinds>;

void AddSquares(const FaultEquation& equation, const ModelVector& value, Squares* squares) {
  const Vector6d left = equation.r + equation.J * value;
  for (int row = 0; row < 6; ++row) (*squares)[KindOfRow(row)] += left[row] * left[row];
  const CornerTerms& corners = equation.corners;
  (*squares)[kCorner] += kIndependentCorners * (corners.squares - 2 * corners.pull.dot(value) +
                                                value.dot(corners.information * value));
}

Squares SquaresOf(const std::vector<FaultEquation>& equations, const ModelVector& value) {
  Squares squares{};
  for (const FaultEquation& equation : equations) AddSquares(equation, value, &squares);
  return squares;
}

double LogLikelihoodOf(double num_rows, double squares, double noise) {
  return num_rows == 0 ? 0.0 : -num_rows * std::log(noise) - squares / (2 * noise * noise);
}

double CentreErrorM(const FaultEquation& equation, const ModelVector& value) {
  return (equation.r + equation.J * value).head<3>().norm();
}

double LogLikelihoodOf(const FaultEquation& equation,
                       const ModelVector& value,
                       const NoiseLevels& noise) {
  Squares squares{};
  AddSquares(equation, value, &squares);
  double sum = 0;
  for (std::size_t kind = 0; kind < noise.size(); ++kind)
    sum += LogLikelihoodOf(NumRows(equation, kind), squares[kind], noise[kind]);
  return sum;
}

// What is said of each sample by the others; of one without which a parameter is open, nothing.
void HoldOut(const std::vector<FaultEquation>& equations,
             const std::vector<int>& columns,
             FaultFit* fit) {
  const NormalEquations all = SumOf(equations, columns, fit->noise);
  for (const FaultEquation& equation : equations) {
    NormalEquations others = all;
    Add(equation, columns, fit->noise, -1, &others);
    const auto inverse = InverseOf(others.H);
    if (!inverse) {
      fit->held_out_errors_m.push_back(std::numeric_limits<double>::infinity());
      fit->held_out_log_likelihoods.push_back(-std::numeric_limits<double>::infinity());
      continue;
    }
    const ModelVector value = Scattered(Eigen::VectorXd(*inverse * others.b), columns);
    fit->held_out_errors_m.push_back(CentreErrorM(equation, value));
    fit->held_out_log_likelihoods.push_back(LogLikelihoodOf(equation, value, fit->noise));
  }
}

}  // namespace

double FaultFit::StandardError(FaultParameter fault) const {
  const int i = kNumExtrinsicParameters + fault;
  return std::sqrt(covariance(i, i));
}

Vector6d FaultFit::ExtrinsicBy(FaultParameter fault) const {
  const int i = kNumExtrinsicParameters + fault;
  return covariance.block<6, 1>(0, i) / covariance(i, i);
}

FaultFit FitFaults(const std::vector<FaultEquation>& equations,
                   const std::vector<FaultParameter>& faults) {
  constexpr int kNumRounds = 20;  // the levels settle to a per mille within about ten
  const std::vector<int> columns = Columns(faults);
  const double num_samples = static_cast<double>(equations.size());
  FaultFit fit;
  fit.noise = kFirstNoise;
  for (int round = 0; round < kNumRounds; ++round) {
    const NormalEquations sum = SumOf(equations, columns, fit.noise);
    const auto inverse = InverseOf(sum.H);
    if (!inverse) return {};
    fit.value = Scattered(Eigen::VectorXd(*inverse * sum.b), columns);
    fit.covariance = Scattered(*inverse, columns);
    fit.squares = SquaresOf(equations, fit.value);
    fit.log_likelihood = 0;
    for (const Prior& prior : kPriors) {
      fit.log_likelihood -= 0.5 * std::pow(fit.Value(prior.fault) / prior.sigma, 2);
    }
    for (std::size_t kind = 0; kind < fit.noise.size(); ++kind) {
      const double num_rows = NumRows(equations, kind);
      if (num_rows == 0) continue;
      fit.noise[kind] = std::max(kLeastNoise[kind], std::sqrt(fit.squares[kind] / num_rows));
      fit.log_likelihood += LogLikelihoodOf(num_rows, fit.squares[kind], fit.noise[kind]);
    }
  }
  fit.is_usable = true;
  for (const double error_m : CentreErrorsM(equations, fit)) {
    fit.mean_error_m += error_m / num_samples;
  }
  HoldOut(equations, columns, &fit);
  for (const double error_m : fit.held_out_errors_m) {
    fit.mean_held_out_error_m += error_m / num_samples;
  }
  return fit;
}

std::vector<double> CentreErrorsM(const std::vector<FaultEquation>& equations,
                                  const FaultFit& fit) {
  std::vector<double> errors_m;
  for (const FaultEquation& equation : equations) {
    errors_m.push_back(CentreErrorM(equation, fit.value));
  }
  return errors_m;
}

}  // namespace voqcal
