#include "core/likelihood/likelihood_search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/likelihood/consider_covariance.hpp"
#include "core/likelihood/likelihood_noise.hpp"

namespace voqcal {
namespace {

std::size_t NumRings(const std::vector<LikelihoodPose>& poses) {
  std::size_t num_rings = 1;
  for (const LikelihoodPose& pose : poses) {
    for (const BoardReturn& seen : pose.returns) num_rings = std::max(num_rings, seen.ring + 1);
  }
  return num_rings;
}

}  // namespace

Eigen::VectorXd FaultPriorInformation(const LikelihoodOptions& options, Eigen::Index num_faults) {
  Eigen::VectorXd sigmas_m = Eigen::VectorXd::Constant(num_faults, options.ring_prior_m);
  sigmas_m[kCommon] = options.common_prior_m;
  sigmas_m[kDarkStep] = options.dark_step_prior_m;
  sigmas_m[kLift] = options.outline_lift_prior_m;
  sigmas_m[kRise] = options.outline_rise_prior;
  return sigmas_m.cwiseAbs2().cwiseInverse();
}

LikelihoodSearch::LikelihoodSearch(std::vector<LikelihoodPose> poses,
                                   const Eigen::Isometry3d& T_camera_lidar_start,
                                   const LikelihoodOptions& options)
    : poses_(std::move(poses)), options_(options) {
  const auto num_camera_faults = poses_.empty() ? 0 : poses_.front().camera_faults.NumFaults();
  const auto num_faults =
      kFirstRing + static_cast<Eigen::Index>(NumRings(poses_)) + num_camera_faults;
  state_.num_camera_faults = num_camera_faults;
  state_.T_camera_lidar = T_camera_lidar_start;
  state_.faults = Eigen::VectorXd::Zero(num_faults);
  for (const LikelihoodPose& pose : poses_) state_.T_camera_board.push_back(pose.T_camera_board);
  prior_information_ = FaultPriorInformation(options, num_faults);
  if (num_camera_faults > 0) {
    prior_information_.tail(num_camera_faults) =
        poses_.front().camera_faults.prior_sigmas.cwiseAbs2().cwiseInverse();
  }
  is_free_.assign(static_cast<std::size_t>(num_faults), true);
}

void LikelihoodSearch::StartFrom(const LidarBias& bias,
                                 const CameraFaultEstimates& camera,
                                 const LikelihoodNoise& noise) {
  if (static_cast<Eigen::Index>(camera.is_observable.size()) != state_.num_camera_faults) {
    throw std::logic_error("the likelihood that is refined again had other faults of the camera");
  }
  const auto take = [this](Eigen::Index fault, const BiasEstimate& estimate) {
    is_free_[static_cast<std::size_t>(fault)] = estimate.is_observable;
    state_.faults[fault] = estimate.value_m;
  };
  noise_ = noise;
  take(kCommon, bias.common);
  take(kDarkStep, bias.dark_step);
  take(kLift, bias.outline_lift);
  take(kRise, bias.outline_rise);
  for (Eigen::Index i = 0; i < state_.NumRings(); ++i) {
    take(kFirstRing + i, bias.rings.at(static_cast<std::size_t>(i)));
  }
  for (Eigen::Index i = 0; i < state_.num_camera_faults; ++i) {
    const Eigen::Index fault = state_.NumLidarFaults() + i;
    is_free_[static_cast<std::size_t>(fault)] = camera.is_observable[static_cast<std::size_t>(i)];
    state_.faults[fault] = camera.values[i];
  }
}

bool LikelihoodSearch::Minimise(int max_iterations, double small_step) {
  for (int i = 0; i < max_iterations; ++i) {
    const double largest_step = Step();
    if (!std::isfinite(largest_step)) return false;
    if (largest_step < small_step) return true;
  }
  return false;
}

void LikelihoodSearch::UpdateNoise() {
  noise_ = EstimateNoise(poses_, state_, prior_information_, options_, noise_);
}

Eigen::MatrixXd LikelihoodSearch::CovarianceAllFree() const {
  constexpr double kLeastReciprocalCondition = 1e-10;
  const Eigen::MatrixXd information = Equations().information;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return {};
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(eigenvalues[0] > kLeastReciprocalCondition * eigenvalues[eigenvalues.size() - 1])) {
    return {};
  }
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

void LikelihoodSearch::HoldUnobservable(const Eigen::MatrixXd& covariance_all_free) {
  constexpr double kNarrowed = 0.5;  // of the prior's deviation
  for (Eigen::Index i = 0; i < state_.faults.size(); ++i) {
    const double variance = covariance_all_free(kExtrinsicSize + i, kExtrinsicSize + i);
    const bool is_free = variance * prior_information_[i] <= kNarrowed * kNarrowed;
    is_free_[static_cast<std::size_t>(i)] = is_free;
    if (!is_free) state_.faults[i] = 0.0;
  }
}

bool LikelihoodSearch::IsPhysical() const {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Eigen::Isometry3d T_lidar_board =
        state_.T_camera_lidar.inverse() * state_.T_camera_board[i];
    const Eigen::Vector3d centre_m = T_lidar_board.translation();
    if (!(centre_m.dot(poses_[i].outline.T_lidar_board.translation()) > 0.0)) return false;
    if (!(centre_m.dot(T_lidar_board.linear().col(2)) < 0.0)) return false;
    const Eigen::Vector3d centre_camera_m = state_.T_camera_board[i].translation();
    if (!(centre_camera_m.dot(poses_[i].T_camera_board.translation()) > 0.0)) return false;
  }
  return state_.faults.allFinite();
}

SharedEquations LikelihoodSearch::Equations() const {
  SharedEquations equations = Eliminate(poses_, state_, noise_);
  const Eigen::Index num_faults = state_.faults.size();
  equations.information.diagonal().tail(num_faults) += prior_information_;
  equations.pull.tail(num_faults) -= prior_information_.cwiseProduct(state_.faults);
  return equations;
}

Eigen::MatrixXd LikelihoodSearch::Gain(const Eigen::MatrixXd& information) const {
  return GainWithHeld(information, is_free_);
}

Eigen::MatrixXd LikelihoodSearch::Covariance(const SharedEquations& equations) const {
  return ConsiderCovariance(equations.information, prior_information_, is_free_);
}

double LikelihoodSearch::Step() {
  const SharedEquations equations = Equations();
  const Eigen::VectorXd step = Gain(equations.information) * equations.pull;
  state_.T_camera_lidar = PerturbLeft(state_.T_camera_lidar, step.head<kExtrinsicSize>());
  state_.faults += step.tail(state_.faults.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    state_.T_camera_board[i] =
        PerturbLeft(state_.T_camera_board[i], equations.poses[i].BoardStep(step));
  }
  return step.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace voqcal
