#include "core/estimation/refine.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "core/estimation/refine_terms.hpp"
#include "core/least_samples.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// Every point that a term projects lies where the lens model is defined.
bool IsVisible(const BoardPose& pose_lidar,
               const CameraModel& camera,
               const Eigen::Isometry3d& T_camera_lidar) {
  if (!camera.IsInFront(T_camera_lidar * pose_lidar.centre_m)) return false;
  for (const Eigen::Vector3d& corner_m : pose_lidar.corners_m) {
    if (!camera.IsInFront(T_camera_lidar * corner_m)) return false;
  }
  return true;
}

bool AllVisible(const std::vector<const BoardSample*>& samples,
                const CameraModel& camera,
                const Eigen::Isometry3d& T_camera_lidar) {
  for (const BoardSample* sample : samples) {
    if (!IsVisible(sample->lidar.pose, camera, T_camera_lidar)) return false;
    if (!IsVisible(sample->camera.pose, camera, Eigen::Isometry3d::Identity())) return false;
  }
  return true;
}

bool Minimise(const std::vector<RefineTerm>& terms, const RefineOptions& options, Vector6d* delta) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const RefineTerm& term : terms) {
    problem.AddResidualBlock(
        term.cost.get(),
        new ceres::ScaledLoss(
            new ceres::HuberLoss(options.huber_px), term.weight, ceres::TAKE_OWNERSHIP),
        delta->data());
  }
  ceres::Solver::Options solver_options;
  solver_options.linear_solver_type = ceres::DENSE_QR;
  solver_options.num_threads = 1;
  solver_options.logging_type = ceres::SILENT;
  solver_options.max_num_iterations = options.max_iterations;
  // Tight: leave-one-out and replays compare minima, not places where a solver stopped.
  solver_options.function_tolerance = 1e-14;
  solver_options.gradient_tolerance = 1e-12;
  solver_options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

// All residuals of one pose, stacked.
struct PoseResiduals {
  Eigen::MatrixXd J;             // m x 6
  Eigen::VectorXd r;             // m, pixels
  Eigen::VectorXd sqrt_weights;  // m: sqrt(weight * rho')
};

struct Linearisation {
  Matrix6d curvature = Matrix6d::Zero();  // second derivative of the cost, Gauss-Newton's
  std::vector<PoseResiduals> poses;
};

Linearisation LineariseAtStart(const std::vector<RefineTerm>& terms,
                               std::size_t num_poses,
                               double huber_px) {
  constexpr Eigen::Index kRowsPerTerm = 2;
  const auto terms_per_pose = static_cast<Eigen::Index>(terms.size() / num_poses);
  const Eigen::Index rows_per_pose = kRowsPerTerm * terms_per_pose;
  Linearisation linear;
  linear.poses.assign(num_poses,
                      {Eigen::MatrixXd(rows_per_pose, 6),
                       Eigen::VectorXd(rows_per_pose),
                       Eigen::VectorXd(rows_per_pose)});

  const Vector6d delta = Vector6d::Zero();
  const double* parameters = delta.data();
  const ceres::HuberLoss huber(huber_px);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    Eigen::Vector2d r;
    Eigen::Matrix<double, kRowsPerTerm, 6, Eigen::RowMajor> J;
    double* jacobian = J.data();
    if (!terms[i].cost->Evaluate(&parameters, r.data(), &jacobian)) {
      throw std::logic_error("a visible point does not project");
    }
    std::array<double, 3> rho{};  // value, first and second derivative by |r|^2
    huber.Evaluate(r.squaredNorm(), rho.data());
    // Second derivative of rho(|r|^2) / 2 by r: beyond the Huber width, only across r.
    const Eigen::Matrix2d curvature_r =
        rho[1] * Eigen::Matrix2d::Identity() + 2.0 * rho[2] * r * r.transpose();
    linear.curvature += terms[i].weight * J.transpose() * curvature_r * J;
    PoseResiduals& pose = linear.poses[static_cast<std::size_t>(terms[i].pose)];
    const Eigen::Index row = kRowsPerTerm * (static_cast<Eigen::Index>(i) % terms_per_pose);
    pose.J.middleRows<kRowsPerTerm>(row) = J;
    pose.r.segment<kRowsPerTerm>(row) = r;
    pose.sqrt_weights.segment<kRowsPerTerm>(row).setConstant(std::sqrt(terms[i].weight * rho[1]));
  }
  return linear;
}

// The inverse, unless a combination of parameters is left to rounding: units are taken out first.
bool InvertIfRegular(const Matrix6d& curvature, Matrix6d* inverse) {
  constexpr double kLeastReciprocalCondition = 1e-8;
  const Vector6d scale = curvature.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return false;
  const Matrix6d scaled = scale.asDiagonal() * curvature * scale.asDiagonal();
  const Vector6d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Matrix6d>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(eigenvalues[0] > kLeastReciprocalCondition * eigenvalues[5])) return false;
  *inverse = scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  return true;
}

// The pose's weighted residuals as they would be had the fit not bent towards them:
//     (I - G)^-1/2 s,  s = W^1/2 r,  G = W^1/2 J A^-1 J' W^1/2 the pose's leverage
// The correction "CR2" of Bell and McCaffrey 2002, "Bias reduction in standard errors for linear
// regression with multi-stage samples", Survey Methodology 28.
Eigen::VectorXd UnbentResiduals(const PoseResiduals& pose, const Matrix6d& curvature_inverse) {
  // Full leverage leaves nothing to correct from; the bound keeps rounding from being blown up.
  constexpr double kLeastFreedom = 0.01;
  const Eigen::MatrixXd J_weighted = pose.sqrt_weights.asDiagonal() * pose.J;
  const Eigen::MatrixXd freedom = Eigen::MatrixXd::Identity(pose.r.size(), pose.r.size()) -
                                  J_weighted * curvature_inverse * J_weighted.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(freedom);
  const Eigen::VectorXd scale =
      eigen.eigenvalues().cwiseMax(kLeastFreedom).cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd s = pose.sqrt_weights.cwiseProduct(pose.r);
  return eigen.eigenvectors() * scale.asDiagonal() * (eigen.eigenvectors().transpose() * s);
}

// Covariance of an M-estimator whose residuals are correlated within a pose (one lidar board moves
// its centre and its corners together) but not between poses:
//     A^-1 (sum over poses of J_p' W_p^1/2 S W_p^1/2 J_p) A^-1
// A: curvature, J_p: all m rows of pose p, S: m x m second moment of the weighted residuals over
// poses. Pooling S follows Pan 2001, "On the robust variance estimator in generalised estimating
// equations", Biometrika 88; unlike each pose's own product it keeps full rank with few poses.
Matrix6d PooledSandwich(const Linearisation& linear, const Matrix6d& curvature_inverse) {
  const Eigen::Index rows_per_pose = linear.poses.front().r.size();
  Eigen::MatrixXd second_moment = Eigen::MatrixXd::Zero(rows_per_pose, rows_per_pose);
  for (const PoseResiduals& pose : linear.poses) {
    const Eigen::VectorXd s = UnbentResiduals(pose, curvature_inverse);
    second_moment += s * s.transpose() / static_cast<double>(linear.poses.size());
  }
  Matrix6d pull_variance = Matrix6d::Zero();
  for (const PoseResiduals& pose : linear.poses) {
    const Eigen::MatrixXd J_weighted = pose.sqrt_weights.asDiagonal() * pose.J;
    pull_variance += J_weighted.transpose() * second_moment * J_weighted;
  }
  const Matrix6d covariance = curvature_inverse * pull_variance * curvature_inverse;
  return 0.5 * (covariance + covariance.transpose());
}

// The lidar's boards as they would be were all ranges longer.
std::vector<BoardSample> WithRangeOffset(const std::vector<const BoardSample*>& samples,
                                         double offset_m) {
  std::vector<BoardSample> moved(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    moved[i].lidar.pose = samples[i]->lidar.pose;
    moved[i].lidar.sides = samples[i]->lidar.sides;
    moved[i].camera.pose = samples[i]->camera.pose;
    BoardPose& pose = moved[i].lidar.pose;
    pose.centre_m += offset_m * pose.centre_m.normalized();
    for (Eigen::Vector3d& corner_m : pose.corners_m) corner_m += offset_m * corner_m.normalized();
  }
  return moved;
}

std::vector<const BoardSample*> PointersTo(const std::vector<BoardSample>& samples) {
  std::vector<const BoardSample*> pointers;
  for (const BoardSample& sample : samples) pointers.push_back(&sample);
  return pointers;
}

// How the minimum moves if all ranges are longer by `offset_m`: A^-1 of the pull by the residuals
// that this adds. Where a board then leaves the lens, all shorter: only the square is used.
Vector6d MoveByRangeOffset(const std::vector<const BoardSample*>& samples,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const RefineOptions& options,
                           const Linearisation& linear,
                           const Matrix6d& curvature_inverse) {
  std::vector<BoardSample> moved = WithRangeOffset(samples, options.range_offset_m);
  std::vector<const BoardSample*> pointers = PointersTo(moved);
  if (!AllVisible(pointers, camera, T_camera_lidar)) {
    moved = WithRangeOffset(samples, -options.range_offset_m);
    pointers = PointersTo(moved);
  }
  if (!AllVisible(pointers, camera, T_camera_lidar)) {
    return Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const auto terms = MakeRefineTerms(pointers, camera, T_camera_lidar, options);
  const Linearisation there = LineariseAtStart(terms, samples.size(), options.huber_px);
  Vector6d pull = Vector6d::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PoseResiduals& pose = linear.poses[i];
    pull -=
        pose.J.transpose() * pose.sqrt_weights.cwiseAbs2().cwiseProduct(there.poses[i].r - pose.r);
  }
  return curvature_inverse * pull;
}

// The variance of Student's t over the normal's: the residuals measure their own scale, and each
// pose has two that count, its centre's. Nothing if they are too few to.
std::optional<double> FewPosesFactor(std::size_t num_poses) {
  const double freedom = 2.0 * static_cast<double>(num_poses) - 6.0;
  if (freedom <= 2.0) return std::nullopt;
  return freedom / (freedom - 2.0);
}

double CentreRmsPx(const std::vector<const BoardSample*>& samples,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar) {
  double sum_px2 = 0.0;
  for (const BoardSample* sample : samples) {
    const Eigen::Vector3d centre_m = T_camera_lidar * sample->lidar.pose.centre_m;
    sum_px2 +=
        (camera.Project(centre_m) - camera.Project(sample->camera.pose.centre_m)).squaredNorm();
  }
  return std::sqrt(sum_px2 / static_cast<double>(samples.size()));
}

}  // namespace

std::vector<std::string> RefineOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("centre_weight", centre_weight);
  problems.Require(corner_weight >= 0.0, "corner_weight must not be negative", corner_weight);
  problems.RequirePositive("huber_px", huber_px);
  problems.Require(range_offset_m >= 0.0, "range_offset_m must not be negative", range_offset_m);
  problems.RequirePositive("max_iterations", max_iterations);
  return problems.lines();
}

std::string RefinedExtrinsic::Summary() const {
  std::ostringstream text;
  text << "refinement " << ToString(status);
  if (!IsUsable()) return text.str();
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  text.precision(3);
  text << ": centres " << reprojection_rms_px << " px RMS, 1 sigma up to "
       << kDegPerRad * sigma.head<3>().maxCoeff() << " deg and "
       << 1000.0 * sigma.tail<3>().maxCoeff() << " mm";
  return text.str();
}

RefinedExtrinsic RefineExtrinsic(const std::vector<const BoardSample*>& samples,
                                 const CameraModel& camera,
                                 const Eigen::Isometry3d& T_camera_lidar_start,
                                 const RefineOptions& options) {
  RequireUsable("RefineOptions", options.Problems());
  RefinedExtrinsic refined;
  refined.T_camera_lidar = T_camera_lidar_start;
  if (samples.size() < kLeastSamples) {
    refined.status = RefineStatus::kDegenerate;
    return refined;
  }
  if (!AllVisible(samples, camera, T_camera_lidar_start)) return refined;

  Vector6d delta = Vector6d::Zero();
  const auto terms = MakeRefineTerms(samples, camera, T_camera_lidar_start, options);
  if (!Minimise(terms, options, &delta)) return refined;
  const Eigen::Isometry3d T_camera_lidar = PerturbLeft(T_camera_lidar_start, delta);
  if (!AllVisible(samples, camera, T_camera_lidar)) return refined;

  refined.T_camera_lidar = T_camera_lidar;
  refined.reprojection_rms_px = CentreRmsPx(samples, camera, T_camera_lidar);
  const auto terms_at_minimum = MakeRefineTerms(samples, camera, T_camera_lidar, options);
  const Linearisation linear = LineariseAtStart(terms_at_minimum, samples.size(), options.huber_px);
  Matrix6d curvature_inverse;
  if (!InvertIfRegular(linear.curvature, &curvature_inverse)) {
    refined.status = RefineStatus::kDegenerate;
    return refined;
  }
  if (const std::optional<double> factor = FewPosesFactor(samples.size())) {
    const Vector6d by_offset =
        MoveByRangeOffset(samples, camera, T_camera_lidar, options, linear, curvature_inverse);
    refined.covariance =
        *factor * PooledSandwich(linear, curvature_inverse) + by_offset * by_offset.transpose();
  }
  refined.status = RefineStatus::kConverged;
  return refined;
}

}  // namespace voqcal
