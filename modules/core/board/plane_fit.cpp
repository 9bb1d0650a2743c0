#include "core/board/plane_fit.hpp"

#include <cstddef>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace voqcal {

Eigen::Matrix3d PointMoments::CovarianceM2() const {
  const Eigen::Vector3d mean_m = MeanM();
  const Eigen::Vector3d xx_yy_zz = squares_m2 / num - mean_m.cwiseProduct(mean_m);
  const double yz = products_m2.x() / num - mean_m.y() * mean_m.z();
  const double zx = products_m2.y() / num - mean_m.z() * mean_m.x();
  const double xy = products_m2.z() / num - mean_m.x() * mean_m.y();
  Eigen::Matrix3d covariance_m2;
  covariance_m2 << xx_yy_zz.x(), xy, zx, xy, xx_yy_zz.y(), yz, zx, yz, xx_yy_zz.z();
  return covariance_m2;
}

PlaneFit FitPlane(const PointMoments& moments) {
  PlaneFit plane;
  if (moments.num <= 0) return plane;
  plane.point_m = moments.MeanM();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(
      moments.CovarianceM2());  // closed form: thousands of these are fitted in a sweep
  plane.normal = solver.eigenvectors().col(0).normalized();
  if (plane.normal.dot(plane.point_m) > 0) plane.normal = -plane.normal;
  plane.spread_m = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return plane;
}

PlaneFit FitPlaneRobustly(const std::vector<Eigen::Vector3d>& points_m,
                          const PlaneFit& start,
                          double scale_m) {
  constexpr int kNumIterations = 10;  // converges to micrometres in 5 to 8 on real boards
  PlaneFit plane = start;
  for (int iteration = 0; iteration < kNumIterations; ++iteration) {
    PointMoments moments;
    for (const Eigen::Vector3d& point_m : points_m) {
      const double r = plane.DistanceM(point_m) / scale_m;
      moments.Add(point_m, 1.0 / (1.0 + r * r));
    }
    plane = FitPlane(moments);
  }
  return plane;
}

Eigen::Matrix3d PlaneCovariance(const std::vector<Eigen::Vector3d>& points_m,
                                const std::vector<std::uint16_t>& rings,
                                const PlaneFit& plane,
                                const Eigen::Vector3d& centre_m,
                                const Eigen::Vector3d& e1,
                                const Eigen::Vector3d& e2) {
  // A point's distance changes by J * [tilt1; tilt2; offset], J = -[y, -x, 1] in the plane's axes.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  std::map<std::uint16_t, Eigen::Vector3d> score_of_ring;
  double sum_squares_m2 = 0.0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d offset_m = points_m[i] - centre_m;
    const Eigen::Vector3d J(-e2.dot(offset_m), e1.dot(offset_m), -1.0);
    const double r_m = plane.DistanceM(points_m[i]);
    information += J * J.transpose();
    sum_squares_m2 += r_m * r_m;
    if (!rings.empty()) {
      score_of_ring.try_emplace(rings[i], Eigen::Vector3d::Zero()).first->second += r_m * J;
    }
  }
  const double variance_m2 = sum_squares_m2 / static_cast<double>(points_m.size());
  const Eigen::Matrix3d inverse = information.inverse();
  Eigen::Matrix3d spread = variance_m2 * information;
  for (const auto& [ring, score] : score_of_ring) spread += score * score.transpose();
  return inverse * spread * inverse;
}

}  // namespace voqcal
