#pragma once

#include <string>
#include <vector>

#include "core/assessment/worst_error.hpp"

namespace voqcal {

/// When no more samples are needed: the one rule of the guide, the page and the verdict.
struct EnoughOptions {
  ErrorTolerance tolerance;
  /// Fewer are not enough, however certain they seem: what they have in common they cannot show.
  int min_samples = 8;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

struct Enough {
  bool is_enough = false;
  std::string words;  ///< "Enough: 4.2 mm at worst, at 5 m; 5 mm are asked."
};

/// @param worst  predicted by the extrinsic's covariance_given_rig.
Enough JudgeEnough(int num_samples, const WorstError& worst, const EnoughOptions& options);

}  // namespace voqcal
