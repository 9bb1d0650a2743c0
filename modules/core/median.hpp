#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace voqcal {

/// The middle value, or the mean of the two in the middle; NaN if there are none.
inline double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*std::max_element(values.begin(), upper) + *upper);
}

}  // namespace voqcal
