#pragma once

#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// By how much unknowns [extrinsic (6); faults] move for a pull on them: the inverse of their
/// information, with no answer of the faults that are held.
/// @param is_free  of each fault.
Eigen::MatrixXd GainWithHeld(const Eigen::MatrixXd& information, const std::vector<bool>& is_free);

/// Of the same unknowns. Held faults are off by their priors, and shift the others:
///     G + K S K',  K = G A,  S: the variances of the held faults' priors
/// with G the gain and A the information; the "consider covariance" of Schmidt 1966, "Application
/// of state-space methods to navigation problems", Advances in Control Systems 3.
/// @param information        priors of the faults included.
/// @param prior_information  of each fault.
Eigen::MatrixXd ConsiderCovariance(const Eigen::MatrixXd& information,
                                   const Eigen::VectorXd& prior_information,
                                   const std::vector<bool>& is_free);

}  // namespace voqcal
