#include "core/estimation/set_extrinsic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <ceres/tiny_solver.h>

#include "core/board/what_was_measured.hpp"
#include "core/estimation/set_cost.hpp"
#include "core/geometry/rigid.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

// Mean of n_camera n_lidar^T: what the rotation of the normals is made from (Kabsch 1976).
Eigen::Matrix3d NormalCorrelation(const std::vector<const BoardSample*>& set) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const BoardSample* sample : set) {
    sum += sample->camera.pose.normal * sample->lidar.pose.normal.transpose();
  }
  return sum / static_cast<double>(set.size());
}

// The second singular value is about the variance of the normals' directions across their mean. Not
// above the normals' own noise, it leaves the rotation about the mean normal to chance.
bool FixesRotation(const Eigen::Matrix3d& normal_correlation, double sigma_normal_rad) {
  if (!normal_correlation.allFinite()) return false;
  const Eigen::Vector3d singular_values =
      Eigen::JacobiSVD<Eigen::Matrix3d>(normal_correlation).singularValues();
  return singular_values[1] > sigma_normal_rad * sigma_normal_rad;
}

// The mean of c_camera - R c_lidar, each centre for what it is worth.
Eigen::Vector3d TrustedTranslation(const std::vector<const BoardSample*>& set,
                                   const Eigen::Matrix3d& R_camera_lidar) {
  Eigen::Matrix3d sum_of_weights = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const BoardSample* sample : set) {
    const Eigen::Matrix3d trust =
        CentreTrust(sample->lidar, R_camera_lidar, SetExtrinsicOptions{}.sigma_centre_m);
    const Eigen::Matrix3d weight = trust * trust;
    sum_of_weights += weight;
    sum_m += weight * (sample->camera.pose.centre_m - R_camera_lidar * sample->lidar.pose.centre_m);
  }
  return sum_of_weights.llt().solve(sum_m);
}

bool AllInFront(const std::vector<const BoardSample*>& set,
                const CameraModel& camera,
                const Eigen::Isometry3d& T_camera_lidar) {
  for (const BoardSample* sample : set) {
    if (!camera.IsInFront(T_camera_lidar * sample->lidar.pose.centre_m)) return false;
    if (!camera.IsInFront(sample->camera.pose.centre_m)) return false;
  }
  return true;
}

bool AllFinite(const std::vector<const BoardSample*>& set) {
  for (const BoardSample* sample : set) {
    const BoardPose& seen = sample->camera.pose;
    bool is_finite = sample->lidar.pose.centre_m.allFinite() && seen.centre_m.allFinite();
    for (const Eigen::Vector3d& corner_m : seen.corners_m) {
      is_finite = is_finite && corner_m.allFinite();
    }
    if (!is_finite) return false;
  }
  return true;
}

}  // namespace

std::string ToString(SetStatus status) {
  switch (status) {
    case SetStatus::kConverged:
      return "converged";
    case SetStatus::kNotConverged:
      return "not converged";
    case SetStatus::kDegenerate:
      return "degenerate";
  }
  throw std::logic_error("unknown SetStatus");
}

std::vector<std::string> SetExtrinsicOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("sigma_normal_rad", sigma_normal_rad);
  problems.RequirePositive("sigma_centre_m", sigma_centre_m);
  problems.RequirePositive("sigma_centre_px", sigma_centre_px);
  problems.RequirePositive("max_iterations", max_iterations);
  return problems.lines();
}

Eigen::Isometry3d AnalyticExtrinsic(const std::vector<const BoardSample*>& set) {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() = NearestRotation(NormalCorrelation(set));
  Eigen::Vector3d translation_sum_m = Eigen::Vector3d::Zero();
  for (const BoardSample* sample : set) {
    translation_sum_m +=
        sample->camera.pose.centre_m - T_camera_lidar.linear() * sample->lidar.pose.centre_m;
  }
  T_camera_lidar.translation() = translation_sum_m / static_cast<double>(set.size());
  if (!std::all_of(
          set.begin(), set.end(), [](const BoardSample* s) { return IsWhole(s->lidar); })) {
    T_camera_lidar.translation() = TrustedTranslation(set, T_camera_lidar.linear());
  }
  return T_camera_lidar;
}

SetExtrinsic EstimateSetExtrinsic(const std::vector<const BoardSample*>& set,
                                  const CameraModel& camera,
                                  const SetExtrinsicOptions& options) {
  RequireUsable("SetExtrinsicOptions", options.Problems());

  SetExtrinsic result;
  constexpr std::size_t kMinPoses = 3;
  if (set.size() < kMinPoses || !AllFinite(set) ||
      !FixesRotation(NormalCorrelation(set), options.sigma_normal_rad)) {
    result.status = SetStatus::kDegenerate;
    return result;
  }
  const Eigen::Isometry3d T_camera_lidar_start = AnalyticExtrinsic(set);
  result.T_camera_lidar = T_camera_lidar_start;
  if (!AllInFront(set, camera, T_camera_lidar_start)) return result;

  const std::vector<SetPose> poses =
      SetPosesOf(set, camera, T_camera_lidar_start.linear(), options);
  const SetCost cost{poses, camera, T_camera_lidar_start, options};
  ceres::TinySolver<SetCost> solver;
  solver.options.max_num_iterations = options.max_iterations;
  solver.options.function_tolerance = 1e-14;  // TinySolver's is absolute, of whitened residuals
  solver.options.cost_threshold = 1e-24;
  Vector6d delta = Vector6d::Zero();
  solver.Solve(cost, &delta);

  result.T_camera_lidar = PerturbLeft(T_camera_lidar_start, delta);
  result.cost = solver.summary.final_cost;
  const bool has_converged =
      solver.summary.status != ceres::TinySolver<SetCost>::HIT_MAX_ITERATIONS;
  if (has_converged && delta.allFinite() && AllInFront(set, camera, result.T_camera_lidar)) {
    result.status = SetStatus::kConverged;
  }
  return result;
}

}  // namespace voqcal
