#include "core/camera_detection/planar_pose.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <ceres/rotation.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>
#include <opencv2/calib3d.hpp>

namespace voqcal {
namespace {

/// Pixel errors of all points:
///     r_i = project(Exp(w) R p_i + t + d) - u_i                     r: 2 N, px
/// Parameters: [w_rad; d_m], 6: PerturbLeft of T_camera_board = (R, t).
struct ReprojectionErrors {
  const CameraModel& camera;
  const std::vector<Eigen::Vector3d>& points_board_m;
  const std::vector<Eigen::Vector2d>& pixels_px;
  Eigen::Isometry3d T_camera_board;

  int NumResiduals() const { return static_cast<int>(2 * pixels_px.size()); }

  template <typename T>
  bool operator()(const T* delta, T* residuals) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> shift_m(delta + 3);
    for (std::size_t i = 0; i < pixels_px.size(); ++i) {
      const Eigen::Vector3d arm_m = T_camera_board.linear() * points_board_m[i];
      const Eigen::Matrix<T, 3, 1> arm = arm_m.cast<T>();
      Eigen::Matrix<T, 3, 1> point;
      ceres::AngleAxisRotatePoint(delta, arm.data(), point.data());
      point += T_camera_board.translation().cast<T>() + shift_m;
      Eigen::Map<Eigen::Matrix<T, 2, 1>> residual(residuals + 2 * i);
      residual = camera.Project(point) - pixels_px[i].cast<T>();
    }
    return true;
  }
};

using ErrorFunction =
    ceres::TinySolverAutoDiffFunction<ReprojectionErrors, Eigen::Dynamic, 6, double>;

// A rotation that brings all rays before the image plane: none if they are, else their middle goes
// to the axis (a fisheye sees boards beside itself and behind).
Eigen::Matrix3d FacingTurn(const std::vector<Eigen::Vector3d>& rays_camera) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  bool is_ahead = true;
  for (const Eigen::Vector3d& ray : rays_camera) {
    sum += ray;
    is_ahead = is_ahead && ray.z() > 0;
  }
  if (is_ahead) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(sum, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// IPPE (Collins and Bartoli 2014) on undistorted rays: the two poses that a plane in perspective
// allows, better first. Empty where a pixel has no ray or OpenCV finds the points degenerate.
std::vector<Eigen::Isometry3d> StartPoses(const CameraModel& camera,
                                          const std::vector<Eigen::Vector3d>& points_board_m,
                                          const std::vector<Eigen::Vector2d>& pixels_px) {
  std::vector<Eigen::Vector3d> rays_camera;
  for (const Eigen::Vector2d& pixel_px : pixels_px) {
    const auto ray = camera.Unproject(pixel_px);
    if (!ray) return {};
    rays_camera.push_back(*ray);
  }
  const Eigen::Matrix3d R_facing_camera = FacingTurn(rays_camera);
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const Eigen::Vector3d ray = R_facing_camera * rays_camera[i];
    if (ray.z() <= 0) return {};
    points.emplace_back(points_board_m[i].x(), points_board_m[i].y(), points_board_m[i].z());
    rays.emplace_back(ray.x() / ray.z(), ray.y() / ray.z());
  }
  std::vector<cv::Vec3d> rotations;
  std::vector<cv::Vec3d> translations;
  try {
    cv::solvePnPGeneric(points,
                        rays,
                        cv::Matx33d::eye(),
                        cv::noArray(),
                        rotations,
                        translations,
                        false,
                        cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return {};
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = ExpSO3({rotations[i][0], rotations[i][1], rotations[i][2]});
    T.translation() << translations[i][0], translations[i][1], translations[i][2];
    if (T.matrix().allFinite()) poses.push_back(R_facing_camera.transpose() * T);
  }
  return poses;
}

// Levenberg-Marquardt from `start`.
PlanarPose Refined(const CameraModel& camera,
                   const std::vector<Eigen::Vector3d>& points_board_m,
                   const std::vector<Eigen::Vector2d>& pixels_px,
                   const Eigen::Isometry3d& start) {
  ReprojectionErrors errors{camera, points_board_m, pixels_px, start};
  const ErrorFunction function(errors);
  ceres::TinySolver<ErrorFunction> solver;
  solver.options.max_num_iterations = 50;
  solver.options.gradient_tolerance = 1e-12;
  solver.options.parameter_tolerance = 1e-12;
  Vector6d delta = Vector6d::Zero();
  solver.Solve(function, &delta);

  // Once more at delta = 0, where its derivative is PerturbLeft's.
  PlanarPose pose;
  pose.T_camera_board = PerturbLeft(start, delta);
  errors.T_camera_board = pose.T_camera_board;
  const ErrorFunction at_pose(errors);
  delta.setZero();
  Eigen::VectorXd residuals(errors.NumResiduals());
  Eigen::Matrix<double, Eigen::Dynamic, 6> J(errors.NumResiduals(), 6);
  at_pose(delta.data(), residuals.data(), J.data());
  const double variance_px2 = residuals.squaredNorm() / std::max(1, errors.NumResiduals() - 6);
  const Matrix6d information = J.transpose() * J;
  pose.covariance = variance_px2 * information.ldlt().solve(Matrix6d::Identity());
  pose.reprojection_rms_px =
      std::sqrt(residuals.squaredNorm() / static_cast<double>(pixels_px.size()));
  return pose;
}

bool IsSeenFromFront(const CameraModel& camera,
                     const std::vector<Eigen::Vector3d>& points_board_m,
                     const PlanarPose& pose) {
  if (!std::isfinite(pose.reprojection_rms_px) || !pose.covariance.allFinite()) return false;
  const Eigen::Isometry3d& T_camera_board = pose.T_camera_board;
  if (T_camera_board.linear().col(2).dot(T_camera_board.translation()) >= 0) return false;
  return std::all_of(points_board_m.begin(), points_board_m.end(), [&](const auto& point) {
    return camera.IsInFront(T_camera_board * point);
  });
}

// Weighs the second minimum of the squared errors. With residuals of variance s^2, by their
// likelihoods:
//     p_mirrored / p_best = exp(-(sum of squares of mirrored - of best) / (2 s^2))
// and the pose's second moment about the best pose gains p d d', d being the difference.
void AddMirrored(const PlanarPose& mirrored, std::size_t num_points, PlanarPose* best) {
  const auto n = static_cast<double>(num_points);
  const Vector6d difference = DifferenceLeft(best->T_camera_board, mirrored.T_camera_board);
  // Within 3 sigma they are one minimum, found twice or flat between.
  constexpr double kSameChi2 = 9.0;
  if (!(difference.dot(best->covariance.ldlt().solve(difference)) > kSameChi2)) return;
  const double best_px2 = n * best->reprojection_rms_px * best->reprojection_rms_px;
  const double mirrored_px2 = n * mirrored.reprojection_rms_px * mirrored.reprojection_rms_px;
  const double variance_px2 = best_px2 / std::max(1.0, 2 * n - 6);
  const double odds = std::exp(-(mirrored_px2 - best_px2) / (2 * variance_px2));
  best->mirrored_probability = odds / (1 + odds);
  best->covariance += best->mirrored_probability * difference * difference.transpose();
}

}  // namespace

std::optional<PlanarPose> FitPlanarPose(const CameraModel& camera,
                                        const std::vector<Eigen::Vector3d>& points_board_m,
                                        const std::vector<Eigen::Vector2d>& pixels_px) {
  std::vector<PlanarPose> minima;
  for (const Eigen::Isometry3d& start : StartPoses(camera, points_board_m, pixels_px)) {
    const PlanarPose pose = Refined(camera, points_board_m, pixels_px, start);
    if (!IsSeenFromFront(camera, points_board_m, pose)) continue;
    minima.push_back(pose);
  }
  if (minima.empty()) return {};
  std::stable_sort(minima.begin(), minima.end(), [](const PlanarPose& a, const PlanarPose& b) {
    return a.reprojection_rms_px < b.reprojection_rms_px;
  });
  PlanarPose best = minima.front();
  if (minima.size() > 1) AddMirrored(minima[1], pixels_px.size(), &best);
  return best;
}

std::optional<PlanarPose> FitSeenCorners(const CameraModel& camera,
                                         const std::vector<Eigen::Vector3d>& points_board_m,
                                         const std::vector<Eigen::Vector2d>& pixels_px) {
  constexpr std::size_t kMinPoints = 4;
  std::vector<Eigen::Vector3d> seen_board_m;
  std::vector<Eigen::Vector2d> seen_px;
  for (std::size_t i = 0; i < points_board_m.size(); ++i) {
    if (!pixels_px[i].allFinite()) continue;
    seen_board_m.push_back(points_board_m[i]);
    seen_px.push_back(pixels_px[i]);
  }
  if (seen_px.size() < kMinPoints) return std::nullopt;
  return FitPlanarPose(camera, seen_board_m, seen_px);
}

}  // namespace voqcal
