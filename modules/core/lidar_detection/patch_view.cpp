#include "core/lidar_detection/patch_view.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace voqcal {

PlaneFrame::PlaneFrame(const PlaneFit& fit, const Eigen::Vector3d& along)
    : plane(fit),
      e1((along - fit.normal.dot(along) * fit.normal).normalized()),
      e2(fit.normal.cross(e1)) {}

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

void PatchView::Classify(const PlaneFrame& frame, double band_m) {
  constexpr double kMinGrazing = 0.1;  // flatter than 6 degrees a plane cannot be measured
  // Just behind the plane a beam was half on the board: it does not tell where the board ends.
  const double mixed_m = 2 * band_m;
  outline_.clear();
  outline_.reserve(beams_.size());
  blocked_.clear();
  hits_.clear();
  const PlaneFit& plane = frame.plane;
  const double offset_m = plane.normal.dot(plane.point_m);
  const Eigen::Vector2d origin_m(frame.e1.dot(plane.point_m), frame.e2.dot(plane.point_m));
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const Eigen::Vector3d& direction = beams_[i].direction;
    const double cosine = plane.normal.dot(direction);
    if (cosine > -kMinGrazing) continue;
    const double plane_range_m = offset_m / cosine;
    const Eigen::Vector2d position_m =
        plane_range_m * Eigen::Vector2d(frame.e1.dot(direction), frame.e2.dot(direction)) -
        origin_m;
    if (position_m.squaredNorm() > radius_m_ * radius_m_) continue;
    const double behind_m = (beams_[i].range_m - plane_range_m) * -cosine;
    if (std::abs(behind_m) <= band_m) {
      hits_.push_back(i);
      outline_.push_back({position_m, true});
    } else if (behind_m > mixed_m) {
      outline_.push_back({position_m, false});
    } else if (behind_m < 0) {
      blocked_.push_back({position_m, -behind_m});
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
