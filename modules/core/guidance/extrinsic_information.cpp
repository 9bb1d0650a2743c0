#include "core/guidance/extrinsic_information.hpp"

#include <algorithm>
#include <cmath>

#include "core/guidance/expected_sample.hpp"
#include "core/likelihood/consider_covariance.hpp"
#include "core/likelihood/likelihood_search.hpp"

namespace voqcal {
namespace {

// Broad: any first sample tells a hundred times more.
constexpr double kPriorRad = 0.5;
constexpr double kPriorM = 0.5;

Eigen::VectorXd FaultsOf(const LidarBias& bias, Eigen::Index num_faults) {
  Eigen::VectorXd faults = Eigen::VectorXd::Zero(num_faults);
  faults[kCommon] = bias.common.value_m;
  faults[kDarkStep] = bias.dark_step.value_m;
  faults[kLift] = bias.outline_lift.value_m;
  faults[kRise] = bias.outline_rise.value_m;
  const auto num_rings = std::min(num_faults - kFirstRing - kNumChessboardTurns,
                                  static_cast<Eigen::Index>(bias.rings.size()));
  for (Eigen::Index i = 0; i < num_rings; ++i) {
    faults[kFirstRing + i] = bias.rings[static_cast<std::size_t>(i)].value_m;
  }
  return faults;
}

// Unless the likelihood was there and told, all.
std::vector<bool> FreeFaults(const LidarBias& bias, Eigen::Index num_faults) {
  std::vector<bool> is_free(static_cast<std::size_t>(num_faults), true);
  if (!bias.IsObservable()) return is_free;
  is_free[kCommon] = bias.common.is_observable;
  is_free[kDarkStep] = bias.dark_step.is_observable;
  is_free[kLift] = bias.outline_lift.is_observable;
  is_free[kRise] = bias.outline_rise.is_observable;
  return is_free;
}

}  // namespace

ExtrinsicInformation::ExtrinsicInformation(const std::vector<const BoardSample*>& samples,
                                           const ExtrinsicBelief& belief,
                                           const LikelihoodOptions& options,
                                           int num_rings)
    : belief_(belief),
      options_(options),
      num_faults_(kFirstRing + num_rings + kNumChessboardTurns),
      prior_information_(FaultPriorInformation(options, num_faults_)),
      is_free_(FreeFaults(belief.bias, num_faults_)) {
  prior_information_.tail<kNumChessboardTurns>() =
      ChessboardTurnTerms().prior_sigmas.cwiseAbs2().cwiseInverse();
  information_ = InformationOf(samples, belief.bias, belief.noise);
  information_.diagonal().tail(num_faults_) += prior_information_;
  information_.diagonal().head<3>().array() += 1.0 / (kPriorRad * kPriorRad);
  information_.diagonal().segment<3>(3).array() += 1.0 / (kPriorM * kPriorM);
}

Eigen::MatrixXd ExtrinsicInformation::InformationOf(const std::vector<const BoardSample*>& samples,
                                                    const LidarBias& bias,
                                                    const LikelihoodNoise& noise) const {
  LikelihoodState state;
  state.T_camera_lidar = belief_.T_camera_lidar;
  state.faults = FaultsOf(bias, num_faults_);
  state.num_camera_faults = kNumChessboardTurns;
  std::vector<LikelihoodPose> poses;
  for (const BoardSample* sample : samples) {
    poses.push_back(MakeLikelihoodPose(*sample, bias.shades, belief_.T_camera_lidar));
    poses.back().camera_faults = ChessboardTurnTerms();
    state.T_camera_board.push_back(poses.back().T_camera_board);
  }
  return Eliminate(poses, state, noise).information;
}

Matrix6d ExtrinsicInformation::CovarianceOf(const Eigen::MatrixXd& information) const {
  return ConsiderCovariance(information, prior_information_, is_free_)
      .topLeftCorner<kExtrinsicSize, kExtrinsicSize>();
}

Matrix6d ExtrinsicInformation::Covariance() const { return CovarianceOf(information_); }

Matrix6d ExtrinsicInformation::CovarianceWith(const BoardSample& expected) const {
  return CovarianceOf(information_ + InformationOf(expected));
}

Eigen::MatrixXd ExtrinsicInformation::InformationOf(const BoardSample& expected) const {
  LikelihoodNoise noise = belief_.noise;
  noise.range_m /= std::sqrt(static_cast<double>(kExpectedThinning));
  // Without faults: an expected sample has none.
  return InformationOf({&expected}, LidarBias{}, noise);
}

}  // namespace voqcal
