#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// The rays that stand for a beam, a cone of some width: the centre's first, then 6 and 12 on
/// circles that share its disc evenly.
class BeamRays {
 public:
  explicit BeamRays(double divergence_rad);

  /// Unit directions of the rays around a beam's centre; just the centre if the beam has no width.
  std::vector<Eigen::Vector3d> Around(const Eigen::Vector3d& centre) const;

 private:
  double divergence_rad_;
  std::array<Eigen::Vector2d, 18> unit_circle_;  ///< Cosine and sine of each ray's place.
};

/// Directions from the origin that can meet a ball.
class ViewCone {
 public:
  ViewCone(const Eigen::Vector3d& centre_m, double radius_m, double margin_rad);

  bool Holds(const Eigen::Vector3d& direction) const { return axis_.dot(direction) >= min_cosine_; }

 private:
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitX();
  double min_cosine_ = -1.0;  // all of them
};

}  // namespace voqcal
