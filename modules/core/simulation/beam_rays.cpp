#include "core/simulation/beam_rays.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace voqcal {
namespace {

constexpr int kNumInner = 6;
constexpr int kNumOuter = 12;
constexpr double kInnerShare = 0.46;  // of the beam's half width: the middle of their areas
constexpr double kOuterShare = 0.84;

}  // namespace

BeamRays::BeamRays(double divergence_rad) : divergence_rad_(divergence_rad) {
  std::size_t ray = 0;
  for (const int count : {kNumInner, kNumOuter}) {
    for (int i = 0; i < count; ++i) {
      const double angle = (i + 0.5) * 2.0 * M_PI / count;
      unit_circle_[ray++] = {std::cos(angle), std::sin(angle)};
    }
  }
}

std::vector<Eigen::Vector3d> BeamRays::Around(const Eigen::Vector3d& centre) const {
  std::vector<Eigen::Vector3d> rays{centre};
  if (divergence_rad_ == 0) return rays;
  rays.reserve(1 + unit_circle_.size());
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(centre).normalized();
  const Eigen::Vector3d up = centre.cross(left);
  for (std::size_t i = 0; i < unit_circle_.size(); ++i) {
    const double radius = divergence_rad_ / 2 * (i < kNumInner ? kInnerShare : kOuterShare);
    rays.push_back(
        (centre + radius * (unit_circle_[i].x() * left + unit_circle_[i].y() * up)).normalized());
  }
  return rays;
}

ViewCone::ViewCone(const Eigen::Vector3d& centre_m, double radius_m, double margin_rad) {
  const double distance_m = centre_m.norm();
  if (distance_m <= radius_m) return;
  axis_ = centre_m / distance_m;
  min_cosine_ = std::cos(std::min(std::asin(radius_m / distance_m) + margin_rad, M_PI));
}

}  // namespace voqcal
