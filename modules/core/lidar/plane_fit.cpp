#include "core/lidar/plane_fit.hpp"

#include <algorithm>
#include <cmath>
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
  constexpr int kMaxIterations = 10;  // converges to micrometres in 5 to 8 on real boards
  constexpr double kSmallTurn = 1e-6;
  constexpr double kSmallShiftM = 1e-6;
  PlaneFit plane = start;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    PointMoments moments;
    for (const Eigen::Vector3d& point_m : points_m) {
      const double r = plane.DistanceM(point_m) / scale_m;
      moments.Add(point_m, 1.0 / (1.0 + r * r));
    }
    const PlaneFit before = plane;
    plane = FitPlane(moments);
    if ((plane.normal - before.normal).norm() < kSmallTurn &&
        std::abs(before.DistanceM(plane.point_m)) < kSmallShiftM) {
      break;
    }
  }
  return plane;
}

Eigen::Matrix3d PlaneCovariance(const std::vector<Eigen::Vector3d>& points_m,
                                const std::vector<std::uint16_t>& rings,
                                const PlaneFit& plane,
                                const Eigen::Vector3d& centre_m,
                                const Eigen::Vector3d& e1,
                                const Eigen::Vector3d& e2,
                                double line_sigma_m) {
  // A point's distance changes by J * [tilt1; tilt2; offset], J = -[y, -x, 1] in the plane's axes.
  constexpr double kNumParameters = 3.0;
  constexpr double kNumLinesExpected = 4.0;  // the weight of what is expected of a line
  struct Line {
    double num = 0.0;
    double sum_m = 0.0;  // of distances
    Eigen::Vector3d J = Eigen::Vector3d::Zero();
  };
  std::map<std::uint16_t, Line> lines;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double sum_squares_m2 = 0.0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d offset_m = points_m[i] - centre_m;
    const Eigen::Vector3d J(-e2.dot(offset_m), e1.dot(offset_m), -1.0);
    const double r_m = plane.DistanceM(points_m[i]);
    information += J * J.transpose();
    sum_squares_m2 += r_m * r_m;
    if (rings.empty()) continue;
    Line& line = lines[rings[i]];
    line.num += 1;
    line.sum_m += r_m;
    line.J += J;
  }
  const auto num = static_cast<double>(points_m.size());
  const auto num_lines = static_cast<double>(lines.size());
  double within_m2 = sum_squares_m2;
  for (const auto& [ring, line] : lines) within_m2 -= line.sum_m * line.sum_m / line.num;
  // Without lines, the plane alone takes the degrees of freedom.
  within_m2 /= std::max(num - std::max(num_lines, kNumParameters), 1.0);
  double between_m2 = 0.0;
  Eigen::Matrix3d line_spread = Eigen::Matrix3d::Zero();
  for (const auto& [ring, line] : lines) {
    const double mean_m = line.sum_m / line.num;
    between_m2 += mean_m * mean_m;
    line_spread += line.J * line.J.transpose();
  }
  // The plane takes three of the lines' means; noise moves each of the others by within / num.
  const double freedom = std::max(num_lines - kNumParameters, 0.0);
  for (const auto& [ring, line] : lines) between_m2 -= freedom / num_lines * within_m2 / line.num;
  between_m2 = (std::max(between_m2, 0.0) + kNumLinesExpected * line_sigma_m * line_sigma_m) /
               (freedom + kNumLinesExpected);
  const Eigen::Matrix3d inverse = information.inverse();
  return inverse * (within_m2 * information + between_m2 * line_spread) * inverse;
}

}  // namespace voqcal
