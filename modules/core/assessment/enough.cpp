#include "core/assessment/enough.hpp"

#include <cmath>

#include "core/format.hpp"
#include "core/problems.hpp"

namespace voqcal {

std::vector<std::string> EnoughOptions::Problems() const {
  ProblemList problems;
  problems.Add(tolerance.Problems());
  problems.Require(min_samples >= 0, "min_samples must not be negative", min_samples);
  return problems.lines();
}

Enough JudgeEnough(int num_samples, const WorstError& worst, const EnoughOptions& options) {
  const bool is_certain = worst.error <= options.tolerance.tolerance;
  const std::string unit = ToString(options.tolerance.unit);
  // Rounded up where it is too much: "5 mm, 5 mm are asked" would not be understood.
  const double shown = is_certain ? worst.error : std::ceil(10.0 * worst.error) / 10.0;
  const std::string error = Format(is_certain ? "%.2g " : "%.3g ", shown) + unit +
                            Format(" at worst, at %.3g m; ", worst.range_m) +
                            Format("%.3g ", options.tolerance.tolerance) + unit + " are asked";
  Enough enough;
  enough.is_enough = is_certain && num_samples >= options.min_samples;
  if (enough.is_enough) {
    enough.words = "Enough: " + error + ".";
  } else if (is_certain) {
    enough.words =
        Format("Fewer than %d are not enough, however certain they seem.", options.min_samples);
  } else {
    enough.words = "Not enough yet: " + error + ".";
  }
  return enough;
}

}  // namespace voqcal
