#include "core/likelihood/likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "core/least_samples.hpp"
#include "core/likelihood/likelihood_search.hpp"
#include "core/likelihood/likelihood_uncertainty.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

// Radians or metres.
constexpr double kSettled = 1e-9;
constexpr double kSettledNearby = 1e-6;  // far below what a score tells

LidarBias BiasOf(const LikelihoodSearch& search, const Eigen::MatrixXd& covariance) {
  const auto estimate = [&](Eigen::Index fault) {
    const Eigen::Index i = kExtrinsicSize + fault;
    return BiasEstimate{
        search.state().faults[fault], std::sqrt(covariance(i, i)), search.IsFree(fault)};
  };
  LidarBias bias;
  bias.common = estimate(kCommon);
  bias.dark_step = estimate(kDarkStep);
  bias.outline_lift = estimate(kLift);
  bias.outline_rise = estimate(kRise);
  for (Eigen::Index i = 0; i < search.state().NumRings(); ++i) {
    bias.rings.push_back(estimate(kFirstRing + i));
  }
  return bias;
}

// The expectation of the faults, given the extrinsic (of a normal distribution).
Eigen::Matrix<double, Eigen::Dynamic, 6> FaultsByExtrinsic(const LikelihoodSearch& search,
                                                           const Eigen::MatrixXd& covariance) {
  const Matrix6d of_extrinsic = covariance.topLeftCorner<6, 6>();
  const Eigen::Index num_faults = search.state().faults.size();
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_extrinsic =
      covariance.block(kExtrinsicSize, 0, num_faults, kExtrinsicSize) * of_extrinsic.inverse();
  for (Eigen::Index i = 0; i < num_faults; ++i) {
    if (!search.IsFree(i)) by_extrinsic.row(i).setZero();
  }
  return by_extrinsic;
}

CameraFaultEstimates CameraFaultEstimatesOf(const LikelihoodSearch& search,
                                            const Eigen::MatrixXd& covariance) {
  const LikelihoodState& state = search.state();
  CameraFaultEstimates faults;
  faults.values = state.CameraFaults();
  faults.standard_errors = covariance.diagonal().tail(state.num_camera_faults).cwiseSqrt();
  for (Eigen::Index i = 0; i < state.num_camera_faults; ++i) {
    faults.is_observable.push_back(search.IsFree(state.NumLidarFaults() + i));
  }
  return faults;
}

LensEstimate LensEstimateOf(const CameraFaultEstimates& faults) {
  LensEstimate lens;
  if (faults.values.size() == 0) return lens;  // of too few samples
  lens.errors = faults.values;
  lens.standard_errors = faults.standard_errors;
  std::copy(faults.is_observable.begin(), faults.is_observable.end(), lens.is_observable.begin());
  return lens;
}

void AddResiduals(const LikelihoodSearch& search, LikelihoodExtrinsic* refined) {
  double sum_range_m2 = 0.0;
  double sum_across_m2 = 0.0;
  int num_outlines = 0;
  for (std::size_t i = 0; i < search.poses().size(); ++i) {
    const BoardAndLidar at = search.state().At(i);
    const LikelihoodPose& pose = search.poses()[i];
    for (const BoardReturn& seen : pose.returns) {
      const double residual_m = seen.range_m - search.state().OffsetM(seen) -
                                RangeToBoardM(at, seen.direction_lidar, nullptr);
      sum_range_m2 += residual_m * residual_m;
      ++refined->num_returns;
    }
    if (!pose.outline.is_whole) continue;
    ++num_outlines;
    sum_across_m2 += OutlineResidual(at, pose.outline, search.state().LiftM(pose.outline), nullptr)
                         .head<2>()
                         .squaredNorm();
  }
  refined->across_rms_m = std::sqrt(sum_across_m2 / num_outlines);
  if (refined->num_returns == 0) return;
  refined->range_rms_m = std::sqrt(sum_range_m2 / refined->num_returns);
}

std::vector<LikelihoodPose> PosesOf(const std::vector<const BoardSample*>& samples,
                                    const ShadeScale& shades,
                                    const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<LikelihoodPose> poses;
  for (const BoardSample* sample : samples) {
    poses.push_back(MakeLikelihoodPose(*sample, shades, T_camera_lidar));
    poses.back().camera_faults = ChessboardTurnTerms();
  }
  return poses;
}

std::vector<LikelihoodPose> PosesWithLens(const std::vector<const BoardSample*>& samples,
                                          const BoardSpec& board,
                                          const CameraModel& camera,
                                          const ShadeScale& shades,
                                          const Eigen::Isometry3d& T_camera_lidar,
                                          const LikelihoodOptions& options) {
  std::vector<LikelihoodPose> poses = PosesOf(samples, shades, T_camera_lidar);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    poses[i].camera_faults =
        LensErrorTerms(*samples[i], board, camera, options.lens_error, options.corner_error_px);
  }
  return poses;
}

LikelihoodExtrinsic RefinePoses(std::vector<LikelihoodPose> poses,
                                const ShadeScale& shades,
                                const Eigen::Isometry3d& T_camera_lidar_start,
                                const LikelihoodOptions& options) {
  constexpr int kNoiseRounds = 4;    // levels settle to a percent in three...
  constexpr int kStepsPerRound = 4;  // ...and do not need the minimum to the last digit
  LikelihoodExtrinsic refined;
  refined.T_camera_lidar = T_camera_lidar_start;
  refined.status = RefineStatus::kDegenerate;
  if (poses.size() < kLeastSamples) return refined;

  LikelihoodSearch search(std::move(poses), T_camera_lidar_start, options);
  for (int round = 0; round < kNoiseRounds; ++round) {
    search.Minimise(kStepsPerRound, kSettled);
    const Eigen::MatrixXd covariance = search.CovarianceAllFree();
    if (covariance.size() == 0) return refined;
    search.HoldUnobservable(covariance);
    search.UpdateNoise();
  }
  refined.status = RefineStatus::kNotConverged;
  if (!search.Minimise(options.max_iterations, kSettled) || !search.IsPhysical()) return refined;
  if (search.CovarianceAllFree().size() == 0) {
    refined.status = RefineStatus::kDegenerate;
    return refined;
  }
  const SharedEquations equations = search.Equations();
  const Eigen::MatrixXd covariance = search.Covariance(equations);
  refined.T_camera_lidar = search.state().T_camera_lidar;
  refined.uncertainty = UncertaintyOf(search, equations);
  refined.bias = BiasOf(search, covariance);
  refined.bias.shades = shades;
  refined.lidar_faults = search.state().faults.head(search.state().NumLidarFaults());
  refined.faults_by_extrinsic = FaultsByExtrinsic(search, covariance);
  refined.camera_faults = CameraFaultEstimatesOf(search, covariance);
  refined.noise = search.noise();
  AddResiduals(search, &refined);
  refined.status = RefineStatus::kConverged;
  return refined;
}

LikelihoodExtrinsic RefinePosesNearby(std::vector<LikelihoodPose> poses,
                                      const LikelihoodExtrinsic& nearby,
                                      const LikelihoodOptions& options) {
  LikelihoodExtrinsic refined = nearby;
  refined.status = RefineStatus::kDegenerate;
  if (poses.size() < kLeastSamples) return refined;
  LikelihoodSearch search(std::move(poses), nearby.T_camera_lidar, options);
  search.StartFrom(nearby.bias, nearby.camera_faults, nearby.noise);
  refined.status = RefineStatus::kNotConverged;
  if (!search.Minimise(options.max_iterations, kSettledNearby)) return refined;
  if (!search.IsPhysical()) return refined;
  const LikelihoodState& state = search.state();
  refined.T_camera_lidar = state.T_camera_lidar;
  const Eigen::Index num_lidar_faults = state.NumLidarFaults();
  refined.lidar_faults.head(num_lidar_faults) = state.faults.head(num_lidar_faults);
  SetFaults(refined.lidar_faults, &refined.bias);
  refined.camera_faults.values = state.CameraFaults();
  refined.status = RefineStatus::kConverged;
  return refined;
}

}  // namespace

LikelihoodExtrinsic RefineByLikelihood(const std::vector<const BoardSample*>& samples,
                                       const Eigen::Isometry3d& T_camera_lidar_start,
                                       const LikelihoodOptions& options) {
  RequireUsable("LikelihoodOptions", options.Problems());
  const ShadeScale shades = MakeShadeScale(samples);
  return RefinePoses(
      PosesOf(samples, shades, T_camera_lidar_start), shades, T_camera_lidar_start, options);
}

LikelihoodExtrinsic RefineNearby(const std::vector<const BoardSample*>& samples,
                                 const LikelihoodExtrinsic& nearby,
                                 const LikelihoodOptions& options) {
  RequireUsable("LikelihoodOptions", options.Problems());
  return RefinePosesNearby(
      PosesOf(samples, nearby.bias.shades, nearby.T_camera_lidar), nearby, options);
}

LikelihoodExtrinsic RefineWithLens(const std::vector<const BoardSample*>& samples,
                                   const BoardSpec& board,
                                   const CameraModel& camera,
                                   const Eigen::Isometry3d& T_camera_lidar_start,
                                   const LikelihoodOptions& options) {
  RequireUsable("LikelihoodOptions", options.Problems());
  const ShadeScale shades = MakeShadeScale(samples);
  LikelihoodExtrinsic refined =
      RefinePoses(PosesWithLens(samples, board, camera, shades, T_camera_lidar_start, options),
                  shades,
                  T_camera_lidar_start,
                  options);
  refined.lens = LensEstimateOf(refined.camera_faults);
  return refined;
}

LikelihoodExtrinsic RefineWithLensNearby(const std::vector<const BoardSample*>& samples,
                                         const BoardSpec& board,
                                         const CameraModel& camera,
                                         const LikelihoodExtrinsic& nearby,
                                         const LikelihoodOptions& options) {
  RequireUsable("LikelihoodOptions", options.Problems());
  LikelihoodExtrinsic refined = RefinePosesNearby(
      PosesWithLens(samples, board, camera, nearby.bias.shades, nearby.T_camera_lidar, options),
      nearby,
      options);
  refined.lens = LensEstimateOf(refined.camera_faults);
  return refined;
}

}  // namespace voqcal
