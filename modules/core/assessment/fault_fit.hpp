#pragma once

#include <array>
#include <vector>

#include "core/assessment/fault_model.hpp"

namespace voqcal {

/// 1 sigma of each kind of residual, in its unit.
using NoiseLevels = std::array<double, kNumResidualKinds>;

/// The extrinsic fitted together with some faults.
struct FaultFit {
  bool is_usable = false;                        ///< False if the samples leave a parameter open.
  ModelVector value = ModelVector::Zero();       ///< Zero where not fitted.
  ModelMatrix covariance = ModelMatrix::Zero();  ///< The same.
  NoiseLevels noise{};
  double log_likelihood = 0;              ///< With these noise levels, but for a constant.
  double mean_error_m = 0;                ///< Of the centres, in space.
  std::vector<double> held_out_errors_m;  ///< The same, each sample left out of the fit in turn.
  double mean_held_out_error_m = 0;
  /// Log-likelihood of all that each sample tells, left out of the fit in turn.
  std::vector<double> held_out_log_likelihoods;

  std::array<double, kNumResidualKinds> squares{};  ///< Sums of squares by kind.

  double Value(FaultParameter fault) const { return value[kNumExtrinsicParameters + fault]; }
  FaultVector Faults() const { return value.tail<kNumFaultParameters>(); }
  double StandardError(FaultParameter fault) const;
  /// How the extrinsic moves for each unit that the fault is larger: the samples tell their sum.
  Vector6d ExtrinsicBy(FaultParameter fault) const;
};

/// Least squares with noise levels of their own for each kind of residual, estimated together with
/// the parameters, which are the extrinsic and `faults`. The chessboards' turn has the prior that
/// the result gives it.
FaultFit FitFaults(const std::vector<FaultEquation>& equations,
                   const std::vector<FaultParameter>& faults);

/// How far each sample's centre stays off in space under `fit`, metres, in order.
std::vector<double> CentreErrorsM(const std::vector<FaultEquation>& equations, const FaultFit& fit);

}  // namespace voqcal
