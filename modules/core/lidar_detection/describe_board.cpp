#include "core/lidar_detection/describe_board.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"
#include "core/lidar/plane_fit.hpp"
#include "core/lidar_detection/lengthened_sides.hpp"
#include "core/lidar_detection/outline_checks.hpp"

namespace voqcal {
namespace {

// Of [rotation_rad; translation_m], left side. The outline gives the shift in the plane and the
// turn about the normal; the plane gives the tilts, and an offset that moves the centre along its
// ray, because the outline was seen along rays. Covers noise, offsets of single scan lines, and
// the unknown spill and thickness, and a bar along a side; not what all lines share, nor a board
// that is bent.
Matrix6d CovarianceOf(const Eigen::Isometry3d& T_lidar_board,
                      const Measurement& m,
                      const PointCloud& cloud_lidar_m,
                      double line_sigma_m) {
  const Eigen::Matrix3d R = T_lidar_board.linear();
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Matrix3d plane = PlaneCovariance(m.positions_m,
                                                RingsOf(m, cloud_lidar_m),
                                                m.frame.plane,
                                                centre_m,
                                                R.col(0),
                                                R.col(1),
                                                line_sigma_m);
  // No board is flatter.
  constexpr double kFlatM = 0.00015;
  const Eigen::Vector3d flat(
      m.model.height_m / std::sqrt(12.0), m.model.width_m / std::sqrt(12.0), 1.0);
  const Eigen::Matrix3d unevenness = (kFlatM * flat.cwiseInverse()).cwiseAbs2().asDiagonal();
  Eigen::Matrix3d outline = m.outline.PoseCovariance();
  outline.diagonal().head<2>() += LengtheningSigmaM(m).cwiseAbs2();
  const Eigen::Vector3d ray = centre_m.normalized();
  Eigen::Matrix<double, 6, 3> from_plane = Eigen::Matrix<double, 6, 3>::Zero();
  from_plane.block<3, 1>(0, 0) = R.col(0);
  from_plane.block<3, 1>(0, 1) = R.col(1);
  from_plane.block<3, 1>(3, 2) = ray / ray.dot(R.col(2));
  Eigen::Matrix<double, 6, 3> from_outline = Eigen::Matrix<double, 6, 3>::Zero();
  from_outline.block<3, 1>(3, 0) = R.col(0);
  from_outline.block<3, 1>(3, 1) = R.col(1);
  from_outline.block<3, 1>(0, 2) = R.col(2);
  return from_plane * (plane + unevenness) * from_plane.transpose() +
         from_outline * outline * from_outline.transpose();
}

}  // namespace

LidarBoard DescribeBoard(const Measurement& m,
                         const std::array<double, 4>& lengths_m,
                         const PointCloud& cloud_lidar_m,
                         const BoardSpec& board,
                         double line_sigma_m) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  LidarBoard found;
  found.pose = PoseFromTransform(T_lidar_board, board);
  found.pose.covariance = CovarianceOf(T_lidar_board, m, cloud_lidar_m, line_sigma_m);
  for (std::size_t i = 0; i < 4; ++i) found.sides[i] = m.sides[i].view;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_measured = found.sides[(i + 3) % 4] == SideView::kMeasured &&
                             found.sides[(i + 1) % 4] == SideView::kMeasured;
    found.edge_lengths_m[i] = is_measured ? lengths_m[i] : std::numeric_limits<double>::quiet_NaN();
  }
  found.log_likelihood = m.outline.log_likelihood - LogLikelihoodOfChance(m.telling);
  double sum_squares_m2 = 0.0;
  PointCloud& points = found.points_lidar_m;
  points.has_intensity = cloud_lidar_m.has_intensity;
  points.has_ring = cloud_lidar_m.has_ring;
  points.has_time = cloud_lidar_m.has_time;
  for (const std::size_t i : m.board_hits) {
    const double distance_m = m.frame.plane.DistanceM(m.view.Beam(i).PositionM());
    sum_squares_m2 += distance_m * distance_m;
    points.points.push_back(cloud_lidar_m.points[m.view.Beam(i).point]);
  }
  found.plane_rms_m = std::sqrt(sum_squares_m2 / static_cast<double>(m.board_hits.size()));
  const std::vector<std::uint16_t> rings = RingsOf(m, cloud_lidar_m);
  found.num_beams = static_cast<int>(std::set<std::uint16_t>(rings.begin(), rings.end()).size());
  return found;
}

}  // namespace voqcal
