#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// 1 sigma of `model`'s least certain corner in its least certain direction, metres.
double CornerSigmaM(const OutlineFit& fit, const OutlineModel& model);

/// `fit` where few scan lines leave the rectangle some play. Between two lines it may lie anywhere,
/// all places being equally likely: there the curvature says that nothing is known, and the
/// likeliest place is arbitrary. So the pose becomes the mean of the posterior along the loosest
/// directions, and the information along them that of its variance. The patch expects the centre
/// within a quarter of a metre (1 sigma). A fit that is sharp stays as it is.
OutlineFit SettleOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         OutlineFit fit);

/// Whether a rectangle turned by five degrees or more explains the beams nearly as well as `best`
/// does, to a likelihood ratio of 150: a few scan lines may leave several. Turns that make the same
/// rectangle, by halves or, of a square, by quarters, are none.
bool HasTurnedRival(const std::vector<OutlineBeam>& beams,
                    const OutlineModel& model,
                    const OutlineFit& best);

/// Whether a rectangle that is wider, higher or both by 60 or 120 mm explains the beams better than
/// `best` does, by a likelihood ratio of 50: then it is a thing of another size.
///
/// @param grows  For width and height, which way to try: 1 longer, -1 shorter, 0 not at all.
bool HasRivalSize(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const OutlineFit& best,
                  const Eigen::Vector2d& grows);

}  // namespace voqcal
