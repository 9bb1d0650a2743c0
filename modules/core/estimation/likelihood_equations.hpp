#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/estimation/likelihood.hpp"
#include "core/estimation/likelihood_terms.hpp"

namespace voqcal {

/// The shared unknowns begin with the extrinsic's perturbation; the faults follow.
constexpr Eigen::Index kExtrinsicSize = 6;

/// Where the search stands.
struct LikelihoodState {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Eigen::VectorXd faults_m;  ///< [common; dark step; rings].
  std::vector<Eigen::Isometry3d> T_camera_board;

  double OffsetM(const BoardReturn& seen) const {
    return faults_m[0] + faults_m[1] * seen.shade +
           faults_m[2 + static_cast<Eigen::Index>(seen.ring)];
  }
  BoardAndLidar At(std::size_t pose) const { return {T_camera_lidar, T_camera_board[pose]}; }
};

/// Gauss-Newton's equations of one pose. Unknowns: [extrinsic 6; board 6; common; dark step;
/// rings].
struct PoseEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;  ///< Minus the gradient.
};

/// What one pose says at `state`; returns and outline with Cauchy weights, which give way to gross
/// errors.
PoseEquations EquationsOf(const LikelihoodPose& pose,
                          const LikelihoodState& state,
                          std::size_t index,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise);

/// All poses with the board poses eliminated (Schur complement), without the faults' priors.
struct SharedEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
  std::vector<PoseEquations> poses;
};
SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise);

/// The step of one board's pose that follows from `shared_step`.
Vector6d BoardStep(const PoseEquations& equations, const Eigen::VectorXd& shared_step);

/// Expected covariances, model error included and scaled by the estimated noise.
Matrix6d CameraCovariance(const LikelihoodPose& pose,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise);
Eigen::Matrix3d OutlineCovariance(const LikelihoodPose& pose,
                                  const LikelihoodOptions& options,
                                  const LikelihoodNoise& noise);

/// Noise levels such that the residuals at `state` are as large as they claim, by medians.
LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current);

}  // namespace voqcal
