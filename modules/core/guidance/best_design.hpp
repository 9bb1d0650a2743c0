#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How often to hold the board at which place, if it could be held there a fraction of a time.
struct Design {
  Eigen::VectorXd times;     ///< Of each candidate; their sum is the number of poses.
  double worst_error = 0.0;  ///< Of the design: no whole number of times does better, but for...
  double least_error = 0.0;  ///< ...at most this: no design of these candidates is below it.
};

/// The design of `num_poses` poses that makes the worst error of a scene least: in the continuous
/// relaxation a convex problem, solved by multiplicative updates (Silvey, Titterington and Torsney
/// 1978, "An algorithm for optimal designs on a finite design space", Communications in Statistics
/// A 7). The largest of the scene's mean squares is approached by their p-norm.
/// @param known       information of [extrinsic (6); faults] without the poses; positive definite.
/// @param candidates  information of the same of one pose each.
/// @param forms       worst error^2 = max over these of trace(form * covariance of the extrinsic).
/// @throws std::invalid_argument without candidates, forms or a positive number of poses.
Design BestDesign(const Eigen::MatrixXd& known,
                  const std::vector<Eigen::MatrixXd>& candidates,
                  const std::vector<Matrix6d>& forms,
                  double num_poses);

}  // namespace voqcal
