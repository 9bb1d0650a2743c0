#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// Where a beam meets the board's plane, and what it says: the board is there, or it is not.
struct OutlineBeam {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< In the plane's own axes.
  bool is_hit = false;  ///< The return lies on the plane; otherwise clearly behind it.
};

/// A rectangle in the plane.
struct RectanglePose {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double angle_rad = 0.0;  ///< From the plane's first axis to the rectangle's width.

  /// From the plane's axes to the rectangle's: x along the width, y along the height.
  Eigen::Vector2d ToRectangle(const Eigen::Vector2d& position_m) const;
};

/// Probability that a beam hits: the unit step at each side of the rectangle, blurred by the beam's
/// footprint, times a share of beams that tell nothing:
///     p = outlier_share / 2 + (1 - outlier_share) * prod_k L((m_k + spill) / blur_m),
///     L(t) = 1 / (1 + e^-t)
/// with m_k the distance inside side k. A beam that is less than half on the board still returns
/// its range: hits spill over the edges, by the same on all sides, so the spill is fitted too and
/// does not bias the centre.
struct OutlineModel {
  double width_m = 0.0;
  double height_m = 0.0;
  double blur_m = 0.01;
  double outlier_share = 0.02;
  double spill_m = 0.0;         ///< What the spill is expected to be...
  double spill_sigma_m = 0.01;  ///< ...and how surely (1 sigma).
};

struct OutlineFit {
  RectanglePose pose;
  double spill_m = 0.0;
  double log_likelihood = 0.0;
  /// Fisher information of [x; y; angle; spill], x and y along the rectangle's axes (m, m, rad, m).
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();

  /// Of [x; y; angle], the spill being unknown.
  Eigen::Matrix3d PoseCovariance() const;
};

/// The log-likelihood of `beams` and its curvature at `pose` and `spill_m`.
OutlineFit EvaluateOutline(const std::vector<OutlineBeam>& beams,
                           const OutlineModel& model,
                           const RectanglePose& pose,
                           double spill_m);

/// The most likely rectangle of the model's size near `start`: Fisher scoring (expected second
/// derivatives) with Levenberg-Marquardt damping.
OutlineFit RefineOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const RectanglePose& start);

/// The best of many angles about `centre_m`, found with a wide blur and few beams: good enough to
/// reject a patch that is not the board, and for RefineOutline to start from.
OutlineFit SearchOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const Eigen::Vector2d& centre_m);

}  // namespace voqcal
