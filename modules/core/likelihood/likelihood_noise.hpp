#pragma once

#include <vector>

#include "core/likelihood/likelihood_equations.hpp"

namespace voqcal {

/// Noise levels such that the residuals at `state` are as large as they claim: of the returns by
/// their median; of the sightings as in FitWithErrors, by steps towards the maximum of the
/// restricted likelihood from where they are, with the priors of `options`.
/// @param prior_information  of the faults.
LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const Eigen::VectorXd& prior_information,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current);

}  // namespace voqcal
