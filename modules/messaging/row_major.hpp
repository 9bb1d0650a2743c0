#pragma once

#include <Eigen/Core>

namespace voqcal {

/// A covariance as messages hold it: Eigen's own order is by columns.
using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

}  // namespace voqcal
