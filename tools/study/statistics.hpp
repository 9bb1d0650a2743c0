#pragma once

#include <vector>

namespace voqcal {

/// Spearman's rank correlation of x and y, -1 to 1; equal values share their mean rank. NaN if
/// there are fewer than two pairs or one side is constant.
double SpearmanCorrelation(const std::vector<double>& x, const std::vector<double>& y);

/// The indices of `values` in ascending order (ties by index), cut into `num_bins` runs whose
/// lengths differ by at most one; fewer bins if there are fewer values.
std::vector<std::vector<int>> EqualCountBins(const std::vector<double>& values, int num_bins);

double Mean(const std::vector<double>& values);               ///< NaN if empty.
double Largest(const std::vector<double>& values);            ///< NaN if empty or one of them is.
double StandardDeviation(const std::vector<double>& values);  ///< Sample's (n - 1); NaN below two.

}  // namespace voqcal
