#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/lidar/plane_fit.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// A plane with axes of its own: e1 x e2 = normal.
struct PlaneFrame {
  PlaneFit plane;  ///< The origin is its point_m.
  Eigen::Vector3d e1 = Eigen::Vector3d::UnitX();
  Eigen::Vector3d e2 = Eigen::Vector3d::UnitY();

  /// @param along  e1 points this way, as far as the plane allows; not along the normal.
  PlaneFrame(const PlaneFit& fit, const Eigen::Vector3d& along);

  Eigen::Vector2d ToPlane(const Eigen::Vector3d& p_m) const {
    return {e1.dot(p_m - plane.point_m), e2.dot(p_m - plane.point_m)};
  }
  Eigen::Vector3d ToLidar(const Eigen::Vector2d& p_m) const {
    return plane.point_m + p_m.x() * e1 + p_m.y() * e2;
  }
};

/// The returns that can matter to one patch, and what each says of its plane.
class PatchView {
 public:
  /// Keeps the beams in the cone that covers `radius_m` around `middle_m`.
  PatchView(const BeamIndex& beams, const Eigen::Vector3d& middle_m, double radius_m);

  /// Tells hits (up to `band_m` before or behind) from misses against `frame`, within the radius of
  /// its origin.
  void Classify(const PlaneFrame& frame, double band_m);

  const std::vector<OutlineBeam>& Outline() const { return outline_; }
  /// The beams that end in front of the plane.
  const std::vector<BlockedBeam>& Blocked() const { return blocked_; }
  const LidarBeam& Beam(std::size_t i) const { return beams_[i]; }

  /// The hits whose points lie in the rectangle, grown by `margin_m`: indices for Beam().
  std::vector<std::size_t> HitsInside(const PlaneFrame& frame,
                                      const OutlineModel& model,
                                      const RectanglePose& pose,
                                      double margin_m) const;

  std::vector<Eigen::Vector3d> PositionsM(const std::vector<std::size_t>& hits) const;

 private:
  double radius_m_;
  std::vector<LidarBeam> beams_;
  std::vector<OutlineBeam> outline_;
  std::vector<BlockedBeam> blocked_;
  std::vector<std::size_t> hits_;
};

}  // namespace voqcal
