#pragma once

#include <Eigen/Core>

namespace voqcal {

/// True unless a combination of unknowns is left open, to rounding; whatever their units.
/// @param information  symmetric.
bool IsRegular(const Eigen::MatrixXd& information);

}  // namespace voqcal
