#include "core/estimation/likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/estimation/likelihood_equations.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinSamples = 3;

void RequireUsable(const LikelihoodOptions& options) {
  const std::vector<std::string> problems = options.Problems();
  if (!problems.empty()) throw std::invalid_argument("LikelihoodOptions: " + problems.front());
}

std::size_t NumRings(const std::vector<LikelihoodPose>& poses) {
  std::size_t num_rings = 1;
  for (const LikelihoodPose& pose : poses) {
    for (const BoardReturn& seen : pose.returns) num_rings = std::max(num_rings, seen.ring + 1);
  }
  return num_rings;
}

Eigen::VectorXd PriorSigmasM(const LikelihoodOptions& options, Eigen::Index num_faults) {
  Eigen::VectorXd sigmas_m = Eigen::VectorXd::Constant(num_faults, options.ring_prior_m);
  sigmas_m[0] = options.common_prior_m;
  sigmas_m[1] = options.dark_step_prior_m;
  return sigmas_m;
}

// A maximum-likelihood search: data, what is believed of the noise, and where it stands.
class Search {
 public:
  Search(std::vector<LikelihoodPose> poses,
         const Eigen::Isometry3d& T_camera_lidar_start,
         const LikelihoodOptions& options)
      : poses_(std::move(poses)), options_(options) {
    const auto num_faults = static_cast<Eigen::Index>(2 + NumRings(poses_));
    state_.T_camera_lidar = T_camera_lidar_start;
    state_.faults_m = Eigen::VectorXd::Zero(num_faults);
    for (const LikelihoodPose& pose : poses_) state_.T_camera_board.push_back(pose.T_camera_board);
    prior_information_ = PriorSigmasM(options, num_faults).cwiseAbs2().cwiseInverse();
    is_free_.assign(static_cast<std::size_t>(num_faults), true);
  }

  // True if no unknown moved in the last step.
  bool Minimise(int max_iterations) {
    constexpr double kSmallStep = 1e-9;  // radians or metres
    for (int i = 0; i < max_iterations; ++i) {
      const double largest_step = Step();
      if (!std::isfinite(largest_step)) return false;
      if (largest_step < kSmallStep) return true;
    }
    return false;
  }

  void UpdateNoise() { noise_ = EstimateNoise(poses_, state_, options_, noise_); }

  // Of the shared unknowns, all faults free; empty if the poses leave some of them open.
  Eigen::MatrixXd Covariance() const {
    constexpr double kLeastReciprocalCondition = 1e-10;
    const Eigen::MatrixXd information =
        WithPriors(Eliminate(poses_, state_, options_, noise_)).information;
    const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
    if (!scale.allFinite()) return {};
    const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
            .eigenvalues();
    if (!(eigenvalues[0] > kLeastReciprocalCondition * eigenvalues[eigenvalues.size() - 1])) {
      return {};
    }
    return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  }

  // Faults whose prior the data hardly narrow are held at zero from now on.
  void HoldUnobservable(const Eigen::MatrixXd& covariance) {
    constexpr double kNarrowed = 0.5;  // of the prior's deviation
    for (Eigen::Index i = 0; i < state_.faults_m.size(); ++i) {
      const double variance = covariance(kExtrinsicSize + i, kExtrinsicSize + i);
      const bool is_free = variance * prior_information_[i] <= kNarrowed * kNarrowed;
      is_free_[static_cast<std::size_t>(i)] = is_free;
      if (!is_free) state_.faults_m[i] = 0.0;
    }
  }

  // Every ray meets its board from the front.
  bool IsPhysical() const {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const Eigen::Isometry3d T_lidar_board =
          state_.T_camera_lidar.inverse() * state_.T_camera_board[i];
      const Eigen::Vector3d centre_m = T_lidar_board.translation();
      if (!(centre_m.dot(poses_[i].outline.T_lidar_board.translation()) > 0.0)) return false;
      if (!(centre_m.dot(T_lidar_board.linear().col(2)) < 0.0)) return false;
      if (!(state_.T_camera_board[i].translation().z() > 0.0)) return false;
    }
    return state_.faults_m.allFinite();
  }

  const std::vector<LikelihoodPose>& poses() const { return poses_; }
  const LikelihoodState& state() const { return state_; }
  const LikelihoodNoise& noise() const { return noise_; }
  bool IsFree(Eigen::Index fault) const { return is_free_[static_cast<std::size_t>(fault)]; }

 private:
  SharedEquations WithPriors(SharedEquations equations) const {
    const Eigen::Index num_faults = state_.faults_m.size();
    equations.information.diagonal().tail(num_faults) += prior_information_;
    equations.pull.tail(num_faults) -= prior_information_.cwiseProduct(state_.faults_m);
    return equations;
  }

  // One Gauss-Newton step of all unknowns; the largest change of a shared one, or NaN.
  double Step() {
    SharedEquations equations = WithPriors(Eliminate(poses_, state_, options_, noise_));
    for (Eigen::Index i = 0; i < state_.faults_m.size(); ++i) {
      if (IsFree(i)) continue;
      const Eigen::Index held = kExtrinsicSize + i;
      equations.information.row(held).setZero();
      equations.information.col(held).setZero();
      equations.information(held, held) = 1.0;
      equations.pull[held] = 0.0;
    }
    const Eigen::VectorXd step = equations.information.ldlt().solve(equations.pull);
    state_.T_camera_lidar = PerturbLeft(state_.T_camera_lidar, step.head<kExtrinsicSize>());
    state_.faults_m += step.tail(state_.faults_m.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      state_.T_camera_board[i] =
          PerturbLeft(state_.T_camera_board[i], BoardStep(equations.poses[i], step));
    }
    return step.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }

  std::vector<LikelihoodPose> poses_;
  LikelihoodOptions options_;
  LikelihoodNoise noise_;
  LikelihoodState state_;
  Eigen::VectorXd prior_information_;
  std::vector<bool> is_free_;
};

LidarBias BiasOf(const Search& search, const Eigen::MatrixXd& covariance) {
  const auto estimate = [&](Eigen::Index fault) {
    const Eigen::Index i = kExtrinsicSize + fault;
    return BiasEstimate{
        search.state().faults_m[fault], std::sqrt(covariance(i, i)), search.IsFree(fault)};
  };
  LidarBias bias;
  bias.common = estimate(0);
  bias.dark_step = estimate(1);
  for (Eigen::Index i = 2; i < search.state().faults_m.size(); ++i) {
    bias.rings.push_back(estimate(i));
  }
  return bias;
}

void AddResiduals(const Search& search, LikelihoodExtrinsic* refined) {
  double sum_range_m2 = 0.0;
  double sum_across_m2 = 0.0;
  for (std::size_t i = 0; i < search.poses().size(); ++i) {
    const BoardAndLidar at = search.state().At(i);
    const LikelihoodPose& pose = search.poses()[i];
    for (const BoardReturn& seen : pose.returns) {
      const double residual_m = seen.range_m - search.state().OffsetM(seen) -
                                RangeToBoardM(at, seen.direction_lidar, nullptr);
      sum_range_m2 += residual_m * residual_m;
      ++refined->num_returns;
    }
    sum_across_m2 += OutlineResidual(at, pose.outline, nullptr).head<2>().squaredNorm();
  }
  refined->across_rms_m = std::sqrt(sum_across_m2 / static_cast<double>(search.poses().size()));
  if (refined->num_returns == 0) return;
  refined->range_rms_m = std::sqrt(sum_range_m2 / refined->num_returns);
}

}  // namespace

std::vector<std::string> LikelihoodOptions::Problems() const {
  std::vector<std::string> problems;
  const auto require = [&problems](bool is_met, const char* rule, double value) {
    if (is_met) return;
    std::ostringstream text;
    text << rule << ", is " << value;
    problems.push_back(text.str());
  };
  require(common_prior_m > 0.0, "common_prior_m must be positive", common_prior_m);
  require(dark_step_prior_m > 0.0, "dark_step_prior_m must be positive", dark_step_prior_m);
  require(ring_prior_m > 0.0, "ring_prior_m must be positive", ring_prior_m);
  require(outline_error_m > 0.0, "outline_error_m must be positive", outline_error_m);
  require(outline_error_rad > 0.0, "outline_error_rad must be positive", outline_error_rad);
  require(camera_error_m > 0.0, "camera_error_m must be positive", camera_error_m);
  require(camera_error_rad > 0.0, "camera_error_rad must be positive", camera_error_rad);
  require(max_iterations > 0, "max_iterations must be positive", max_iterations);
  return problems;
}

std::string LikelihoodExtrinsic::Summary() const {
  std::ostringstream text;
  text << "likelihood " << ToString(status);
  if (!IsUsable()) return text.str();
  constexpr double kDegreesPerRadian = 180.0 / M_PI;
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  text.precision(3);
  text << ": 1 sigma up to " << kDegreesPerRadian * sigma.head<3>().maxCoeff() << " deg and "
       << 1000.0 * sigma.tail<3>().maxCoeff() << " mm; range offset " << bias.common.Text()
       << ", dark against bright " << bias.dark_step.Text();
  return text.str();
}

LikelihoodExtrinsic RefineByLikelihood(const std::vector<const BoardSample*>& samples,
                                       const Eigen::Isometry3d& T_camera_lidar_start,
                                       const LikelihoodOptions& options) {
  constexpr int kNoiseRounds = 4;    // levels settle to a percent in three...
  constexpr int kStepsPerRound = 4;  // ...and do not need the minimum to the last digit
  RequireUsable(options);
  LikelihoodExtrinsic refined;
  refined.T_camera_lidar = T_camera_lidar_start;
  refined.status = RefineStatus::kDegenerate;
  if (samples.size() < kMinSamples) return refined;

  const ShadeScale shades = MakeShadeScale(samples);
  std::vector<LikelihoodPose> poses;
  for (const BoardSample* sample : samples) {
    poses.push_back(MakeLikelihoodPose(*sample, shades, T_camera_lidar_start));
  }
  Search search(std::move(poses), T_camera_lidar_start, options);
  for (int round = 0; round < kNoiseRounds; ++round) {
    search.Minimise(kStepsPerRound);
    const Eigen::MatrixXd covariance = search.Covariance();
    if (covariance.size() == 0) return refined;
    search.HoldUnobservable(covariance);
    search.UpdateNoise();
  }
  refined.status = RefineStatus::kNotConverged;
  if (!search.Minimise(options.max_iterations) || !search.IsPhysical()) return refined;
  const Eigen::MatrixXd covariance = search.Covariance();
  if (covariance.size() == 0) {
    refined.status = RefineStatus::kDegenerate;
    return refined;
  }
  refined.T_camera_lidar = search.state().T_camera_lidar;
  refined.covariance = covariance.topLeftCorner<6, 6>();
  refined.bias = BiasOf(search, covariance);
  refined.bias.shades = shades;
  refined.noise = search.noise();
  AddResiduals(search, &refined);
  refined.status = RefineStatus::kConverged;
  return refined;
}

}  // namespace voqcal
