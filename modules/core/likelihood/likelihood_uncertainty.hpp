#pragma once

#include "core/likelihood/likelihood_search.hpp"

namespace voqcal {

/// At the minimum that `search` stands at.
///
/// by_likelihood: LikelihoodSearch::Covariance.
/// by_resampling: the poses are what varies. The delete-one jackknife, each pose taken out in one
/// Gauss-Newton step (to first order the variance of a bootstrap over poses, without its dice:
/// Efron and Stein 1981, "The jackknife estimate of variance", Annals of Statistics 9), and the
/// priors' share, which poses do not tell.
LikelihoodUncertainty UncertaintyOf(const LikelihoodSearch& search,
                                    const SharedEquations& equations);

}  // namespace voqcal
