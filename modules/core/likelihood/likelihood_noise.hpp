#pragma once

#include <vector>

#include "core/likelihood/likelihood_equations.hpp"

namespace voqcal {

/// Noise levels such that the residuals at `state` are as large as they claim, by medians.
LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current);

}  // namespace voqcal
