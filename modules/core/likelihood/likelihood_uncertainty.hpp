#pragma once

#include "core/camera/camera_model.hpp"
#include "core/likelihood/likelihood_search.hpp"

namespace voqcal {

/// At the minimum that `search` stands at.
///
/// by_likelihood: LikelihoodSearch::Covariance.
/// by_resampling: the poses are what varies. The delete-one jackknife, each pose taken out in one
/// Gauss-Newton step (to first order the variance of a bootstrap over poses, without its dice:
/// Efron and Stein 1981, "The jackknife estimate of variance", Annals of Statistics 9), and the
/// priors' share, which poses do not tell.
/// by_model_errors: the extrinsic estimated again, in one step, with each of focal length,
/// principal point (x, y) and size of the chessboard off by what `options` holds for plausible;
/// root of the sum of squares. With the lens estimated, of the size of the chessboard only.
///
LikelihoodUncertainty UncertaintyOf(const LikelihoodSearch& search,
                                    const SharedEquations& equations,
                                    const CameraModel& camera,
                                    const LikelihoodOptions& options);

}  // namespace voqcal
