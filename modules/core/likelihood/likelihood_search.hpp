#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/likelihood/likelihood_equations.hpp"

namespace voqcal {

/// Of each fault, before the data speak.
Eigen::VectorXd FaultPriorInformation(const LikelihoodOptions& options, Eigen::Index num_faults);

/// A maximum-likelihood search: data, what is believed of the noise, and where it stands.
class LikelihoodSearch {
 public:
  /// Starts without faults, with the boards where the chessboards are. What the poses'
  /// CameraFaultTerms ask for is among the faults.
  LikelihoodSearch(std::vector<LikelihoodPose> poses,
                   const Eigen::Isometry3d& T_camera_lidar_start,
                   const LikelihoodOptions& options);

  /// Takes over faults, which of them are held at zero, and noise levels.
  void StartFrom(const LidarBias& bias,
                 const CameraFaultEstimates& camera,
                 const LikelihoodNoise& noise);

  /// True if no unknown moved by more than `small_step` (radians or metres) in the last step.
  bool Minimise(int max_iterations, double small_step);

  void UpdateNoise();

  /// Of the shared unknowns, all faults free; empty if the poses leave some of them open.
  Eigen::MatrixXd CovarianceAllFree() const;

  /// Faults whose prior the data narrow to no less than half are held at zero from now on.
  void HoldUnobservable(const Eigen::MatrixXd& covariance_all_free);

  /// Where the search stands, with its held faults: GainWithHeld and ConsiderCovariance.
  Eigen::MatrixXd Gain(const Eigen::MatrixXd& information) const;
  Eigen::MatrixXd Covariance(const SharedEquations& equations) const;

  /// Where the search stands, all faults free, priors included.
  SharedEquations Equations() const;

  /// Every ray meets its board from the front.
  bool IsPhysical() const;

  const std::vector<LikelihoodPose>& poses() const { return poses_; }
  const LikelihoodState& state() const { return state_; }
  const LikelihoodNoise& noise() const { return noise_; }
  const Eigen::VectorXd& prior_information() const { return prior_information_; }
  bool IsFree(Eigen::Index fault) const { return is_free_[static_cast<std::size_t>(fault)]; }

 private:
  /// One Gauss-Newton step of all unknowns; the largest change of a shared one, or NaN.
  double Step();

  std::vector<LikelihoodPose> poses_;
  LikelihoodOptions options_;
  LikelihoodNoise noise_;
  LikelihoodState state_;
  Eigen::VectorXd prior_information_;
  std::vector<bool> is_free_;
};

}  // namespace voqcal
