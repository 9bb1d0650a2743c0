#include "core/likelihood/likelihood_terms.hpp"

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"

namespace voqcal {
namespace {

// Two unit directions across `direction` (unit length), as columns.
Eigen::Matrix<double, 3, 2> Across(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = direction.unitOrthogonal();
  across.col(1) = direction.cross(across.col(0));
  return across;
}

// Rows that turn the board's axes x and y (lidar frame) into the turn about its normal.
struct TurnRows {
  Eigen::RowVector3d by_x;
  Eigen::RowVector3d by_y;
};

TurnRows TurnRowsOf(const Eigen::Isometry3d& T_lidar_board) {
  const Eigen::Vector3d c0 = T_lidar_board.translation();
  const Eigen::Vector3d x0 = T_lidar_board.linear().col(0);
  const Eigen::Vector3d y0 = T_lidar_board.linear().col(1);
  const Eigen::Vector3d m_x = c0.cross(x0);
  const Eigen::Vector3d m_y = c0.cross(y0);
  return {0.5 * m_x.transpose() / m_x.dot(y0), -0.5 * m_y.transpose() / m_y.dot(x0)};
}

}  // namespace

double RangeToBoardM(const BoardAndLidar& at,
                     const Eigen::Vector3d& direction_lidar,
                     Vector12d* J_range) {
  const Eigen::Vector3d n = at.T_camera_board.linear().col(2);
  const Eigen::Vector3d v = at.T_camera_lidar.linear() * direction_lidar;
  const Eigen::Vector3d to_centre_m =
      at.T_camera_board.translation() - at.T_camera_lidar.translation();
  const double slope = n.dot(v);
  const double range_m = n.dot(to_centre_m) / slope;
  if (J_range != nullptr) {
    const Eigen::Vector3d n_by_slope = n / slope;
    J_range->segment<3>(0) = range_m * n_by_slope.cross(v);
    J_range->segment<3>(3) = -n_by_slope;
    J_range->segment<3>(6) = n_by_slope.cross(to_centre_m - range_m * v);
    J_range->segment<3>(9) = n_by_slope;
  }
  return range_m;
}

Eigen::Vector3d PlaneInLidar(const BoardAndLidar& at, Matrix312d* J_plane) {
  const Eigen::Matrix3d R_lidar_camera = at.T_camera_lidar.linear().transpose();
  const Eigen::Vector3d n = at.T_camera_board.linear().col(2);
  const Eigen::Vector3d to_centre_m =
      at.T_camera_board.translation() - at.T_camera_lidar.translation();
  const double distance_m = n.dot(to_centre_m);
  const Eigen::Vector3d plane = R_lidar_camera * n / distance_m;
  if (J_plane != nullptr) {
    // R' n with R perturbed by w changes by R' (n x w); n itself perturbed, by R' (w x n).
    const Eigen::Matrix3d J_normal = R_lidar_camera * Skew(n) / distance_m;
    const Eigen::Vector3d shrink = -plane / distance_m;  // by the plane's distance
    J_plane->block<3, 3>(0, 0) = J_normal;
    J_plane->block<3, 3>(0, 3) = -shrink * n.transpose();
    J_plane->block<3, 3>(0, 6) = -J_normal + shrink * n.cross(to_centre_m).transpose();
    J_plane->block<3, 3>(0, 9) = shrink * n.transpose();
  }
  return plane;
}

OutlineRays OutlineRaysOf(const BoardPose& pose_lidar) {
  OutlineRays outline;
  outline.T_lidar_board = TransformFromPose(pose_lidar);
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.block<2, 3>(0, 3) = Across(pose_lidar.centre_m.normalized()).transpose();
  J.block<1, 3>(2, 0) = outline.T_lidar_board.linear().col(2).transpose();
  outline.covariance = J * pose_lidar.covariance * J.transpose();
  return outline;
}

Eigen::Vector3d OutlineResidual(const BoardAndLidar& at,
                                const OutlineRays& outline,
                                double lift_m,
                                Matrix312d* J_residual) {
  const Eigen::Matrix3d R_lidar_camera = at.T_camera_lidar.linear().transpose();
  const Eigen::Vector3d to_centre_m =
      at.T_camera_board.translation() - at.T_camera_lidar.translation();
  const Eigen::Vector3d x = at.T_camera_board.linear().col(0);
  const Eigen::Vector3d y = at.T_camera_board.linear().col(1);
  const Eigen::Matrix<double, 2, 3> across_of_centre =
      Across(outline.T_lidar_board.translation().normalized()).transpose() * R_lidar_camera;
  const TurnRows turn = TurnRowsOf(outline.T_lidar_board);
  const Eigen::RowVector3d turn_of_x = turn.by_x * R_lidar_camera;
  const Eigen::RowVector3d turn_of_y = turn.by_y * R_lidar_camera;
  if (J_residual != nullptr) {
    // R' c with R perturbed by w on the left changes by R' (c x w); an axis x perturbed by w
    // itself, by R' (w x x).
    J_residual->block<2, 3>(0, 0) = across_of_centre * Skew(to_centre_m);
    J_residual->block<2, 3>(0, 3) = -across_of_centre;
    J_residual->block<2, 3>(0, 6).setZero();
    J_residual->block<2, 3>(0, 9) = across_of_centre;
    const Eigen::RowVector3d turn_by_w = turn_of_x * Skew(x) + turn_of_y * Skew(y);
    J_residual->block<1, 3>(2, 0) = turn_by_w;
    J_residual->block<1, 3>(2, 3).setZero();
    J_residual->block<1, 3>(2, 6) = -turn_by_w;
    J_residual->block<1, 3>(2, 9).setZero();
  }
  Eigen::Vector3d residual;
  residual << across_of_centre * to_centre_m, turn_of_x.dot(x) + turn_of_y.dot(y);
  return residual + lift_m * OutlineByLift(outline);
}

Eigen::Vector3d OutlineByLift(const OutlineRays& outline) {
  const auto across = Across(outline.T_lidar_board.translation().normalized());
  return {across(2, 0), across(2, 1), 0.0};
}

LikelihoodPose MakeLikelihoodPose(const BoardSample& sample,
                                  const ShadeScale& shades,
                                  const Eigen::Isometry3d& T_camera_lidar) {
  LikelihoodPose pose;
  pose.T_camera_board = TransformFromPose(sample.camera.pose);
  pose.covariance = sample.camera.pose.covariance;
  pose.corners_camera_m = sample.camera.pose.corners_m;
  pose.outline = OutlineRaysOf(LidarPoseInCameraOrder(sample, T_camera_lidar));
  pose.outline.is_whole = IsWhole(sample.lidar);
  const PointCloud& cloud = sample.lidar.points_lidar_m;
  for (const LidarPoint& point : cloud.points) {
    const Eigen::Vector3d position_m = point.position_m.cast<double>();
    const double range_m = position_m.norm();
    if (!(range_m > 0.0)) continue;  // a beam without a return
    const bool has_offset = cloud.has_ring && point.ring < kMaxRings;
    pose.returns.push_back({position_m / range_m,
                            range_m,
                            cloud.has_intensity ? shades.ShadeOf(point.intensity) : 0.0,
                            has_offset ? point.ring : std::size_t{0}});
  }
  return pose;
}

}  // namespace voqcal
