#include "core/board/patch_view.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace voqcal {

PlaneFrame::PlaneFrame(const PlaneFit& fit)
    : plane(fit), e1(fit.normal.unitOrthogonal()), e2(fit.normal.cross(e1)) {}

PatchView::PatchView(const BeamIndex& beams, const Eigen::Vector3d& middle_m, double radius_m)
    : radius_m_(radius_m) {
  constexpr std::size_t kMaxBeams = 20000;  // bounds the time on absurdly dense clouds
  const double distance_m = middle_m.norm();
  beams.AppendCone(middle_m / distance_m, std::atan2(radius_m, distance_m), &beams_);
  if (beams_.size() <= kMaxBeams) return;
  std::size_t num_kept = 0;
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    if (IsInShare(i, kMaxBeams, beams_.size())) beams_[num_kept++] = beams_[i];
  }
  beams_.resize(num_kept);
}

void PatchView::Classify(const PlaneFrame& frame) {
  constexpr double kMinGrazing = 0.1;  // flatter than 6 degrees a plane cannot be measured
  // Scan lines of one lidar differ by up to 30 mm and dark from bright squares by 15 mm, both on
  // top of 10 mm of noise (1 sigma): a band that keeps nearly every return of the board.
  constexpr double kBandM = 0.05;
  // Returns in front of the plane are something in the way; just behind it, a beam that was half on
  // the board: neither tells where the board ends.
  constexpr double kMixedM = 0.10;
  outline_.clear();
  outline_.reserve(beams_.size());
  hits_.clear();
  const double offset_m = frame.plane.normal.dot(frame.plane.point_m);
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const double cosine = frame.plane.normal.dot(beams_[i].direction);
    if (cosine > -kMinGrazing) continue;
    const double plane_range_m = offset_m / cosine;
    const Eigen::Vector2d position_m = frame.ToPlane(plane_range_m * beams_[i].direction);
    if (position_m.norm() > radius_m_) continue;
    const double behind_m = (beams_[i].range_m - plane_range_m) * -cosine;
    if (std::abs(behind_m) <= kBandM) {
      hits_.push_back(i);
      outline_.push_back({position_m, true});
    } else if (behind_m > kMixedM) {
      outline_.push_back({position_m, false});
    }
  }
}

std::vector<std::size_t> PatchView::HitsInside(const PlaneFrame& frame,
                                               const OutlineModel& model,
                                               const RectanglePose& pose,
                                               double margin_m) const {
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  std::vector<std::size_t> inside;
  for (const std::size_t i : hits_) {
    const Eigen::Vector2d q_m = T_rectangle_plane * frame.ToPlane(beams_[i].PositionM());
    if (std::abs(q_m.x()) > model.width_m / 2 + margin_m) continue;
    if (std::abs(q_m.y()) > model.height_m / 2 + margin_m) continue;
    inside.push_back(i);
  }
  return inside;
}

std::vector<Eigen::Vector3d> PatchView::PositionsM(const std::vector<std::size_t>& hits) const {
  std::vector<Eigen::Vector3d> points_m;
  points_m.reserve(hits.size());
  for (const std::size_t i : hits) points_m.push_back(beams_[i].PositionM());
  return points_m;
}

}  // namespace voqcal
