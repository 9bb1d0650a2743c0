#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// Count, sum and outer product of points: enough to fit a plane, and they add up.
struct PointMoments {
  double num = 0.0;
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_m2 = Eigen::Vector3d::Zero();   ///< Sums of xx, yy, zz...
  Eigen::Vector3d products_m2 = Eigen::Vector3d::Zero();  ///< ...and of yz, zx, xy.

  void Add(const Eigen::Vector3d& point_m, double weight = 1.0) {
    num += weight;
    sum_m += weight * point_m;
    squares_m2 += weight * point_m.cwiseProduct(point_m);
    products_m2 += weight * Eigen::Vector3d(point_m.y() * point_m.z(),
                                            point_m.z() * point_m.x(),
                                            point_m.x() * point_m.y());
  }
  void Add(const PointMoments& other) {
    num += other.num;
    sum_m += other.sum_m;
    squares_m2 += other.squares_m2;
    products_m2 += other.products_m2;
  }
  Eigen::Vector3d MeanM() const { return sum_m / num; }
  Eigen::Matrix3d CovarianceM2() const;  ///< Of the points about their mean.
};

/// A plane and how the points lie in it: principal axes with the spread (1 sigma) along each.
struct PlaneFit {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();   ///< The points' (weighted) mean.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< Towards the origin.
  Eigen::Vector3d spread_m = Eigen::Vector3d::Zero();  ///< Along the normal, then growing.

  double DistanceM(const Eigen::Vector3d& p_m) const { return normal.dot(p_m - point_m); }
};

/// The plane of least squared distances. Fewer than three points give a meaningless normal.
PlaneFit FitPlane(const PointMoments& moments);

/// FitPlane by iterated reweighting with Cauchy weights 1 / (1 + (distance / scale_m)^2), from
/// `start`: mixed pixels and whatever touches the board hardly count.
PlaneFit FitPlaneRobustly(const std::vector<Eigen::Vector3d>& points_m,
                          const PlaneFit& start,
                          double scale_m);

/// Covariance of a plane: tilts about the orthonormal in-plane axes e1 and e2 (rad, right-handed
/// with e1 x e2 = normal), then the offset along the normal (m) at `centre_m`.
///
/// Two kinds of error, each with one variance estimated from the residuals: independent noise of
/// each point, and an offset that the points of one scan line share (each laser has its own), as
/// in an analysis of variance between and within lines. Both are of this one sweep: what shifts
/// all lines alike (a range offset of the lidar) leaves no residual and is not covered.
///
/// @param rings  Scan line of each point, or empty: then only independent noise counts.
Eigen::Matrix3d PlaneCovariance(const std::vector<Eigen::Vector3d>& points_m,
                                const std::vector<std::uint16_t>& rings,
                                const PlaneFit& plane,
                                const Eigen::Vector3d& centre_m,
                                const Eigen::Vector3d& e1,
                                const Eigen::Vector3d& e2,
                                double line_sigma_m);

}  // namespace voqcal
