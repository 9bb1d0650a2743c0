#include "core/likelihood/likelihood_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/median.hpp"

namespace voqcal {
namespace {

// The squares of LikelihoodNoise's four of a sighting.
enum SightingNoise : std::size_t { kAlongRay, kAcrossRay, kTilt, kTurn, kNumSightingNoises };
using Variances = std::array<double, kNumSightingNoises>;

Variances PriorVariances(const LikelihoodOptions& options) {
  return {options.camera_error_m * options.camera_error_m,
          options.outline_error_m * options.outline_error_m,
          options.camera_error_rad * options.camera_error_rad,
          options.outline_error_rad * options.outline_error_rad};
}

Variances VariancesOf(const LikelihoodNoise& noise) {
  return {noise.along_ray_m * noise.along_ray_m,
          noise.across_ray_m * noise.across_ray_m,
          noise.tilt_rad * noise.tilt_rad,
          noise.turn_rad * noise.turn_rad};
}

void SetVariances(const Variances& variances, LikelihoodNoise* noise) {
  noise->along_ray_m = std::sqrt(variances[kAlongRay]);
  noise->across_ray_m = std::sqrt(variances[kAcrossRay]);
  noise->tilt_rad = std::sqrt(variances[kTilt]);
  noise->turn_rad = std::sqrt(variances[kTurn]);
}

// r'P U P r and tr(P U) of each variance's unit U, with the names of FitWithErrors.
struct Evidence {
  Variances squares{};
  Variances traces{};
};

// The shared unknowns' step to the minimum, and what is then known of them.
struct SharedPosterior {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
};

// Of one pose at the minimum: its board follows the shared unknowns,
//     board = own + by_shared * shared
struct BoardPosterior {
  const SharedPosterior& shared;
  const Matrix6d& covariance;  // with the shared unknowns known
  Vector6d own;
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_shared;

  BoardPosterior(const PoseShare& share, const SharedPosterior& all)
      : shared(all),
        covariance(share.board_covariance),
        own(share.board_covariance * share.board_pull),
        by_shared(-share.board_covariance * share.to_board.transpose()) {}
};

// What is left of a residual r + J_board board + J_shared shared, weighed: W r, and
// P = W - W Post W.
template <int kSize>
struct Left {
  Eigen::Matrix<double, kSize, 1> Pr;
  Eigen::Matrix<double, kSize, kSize> P;

  Left(const Eigen::Matrix<double, kSize, 1>& r,
       const Eigen::Matrix<double, kSize, 6>& J_board,
       Eigen::Matrix<double, kSize, Eigen::Dynamic> by_shared,
       const Eigen::Matrix<double, kSize, kSize>& W,
       const BoardPosterior& board) {
    by_shared += J_board * board.by_shared;
    Pr = W * (r + J_board * board.own + by_shared * board.shared.step);
    P = W - W *
                (J_board * board.covariance * J_board.transpose() +
                 by_shared * board.shared.covariance * by_shared.transpose()) *
                W;
  }
};

void AddChessboard(const LikelihoodPose& pose,
                   const LikelihoodState& state,
                   std::size_t index,
                   const BoardPosterior& board,
                   const LikelihoodNoise& noise,
                   Evidence* evidence) {
  const Eigen::Index num_camera_faults = state.num_camera_faults;
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_shared =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, board.by_shared.cols());
  if (num_camera_faults > 0) {
    by_shared.rightCols(num_camera_faults) = -pose.camera_faults.board_by_faults;
  }
  const Left<6> left(DifferenceLeft(state.ByChessboard(pose), state.T_camera_board[index]),
                     Matrix6d::Identity(),
                     by_shared,
                     CameraCovariance(pose, noise).inverse(),
                     board);
  const Eigen::Vector3d ray = pose.T_camera_board.translation().normalized();
  const Eigen::Vector3d normal = pose.T_camera_board.linear().col(2);
  const Eigen::Vector3d turn = left.Pr.head<3>();
  const Eigen::Matrix3d P_turn = left.P.topLeftCorner<3, 3>();
  evidence->squares[kAlongRay] += std::pow(ray.dot(left.Pr.tail<3>()), 2);
  evidence->traces[kAlongRay] += ray.dot(left.P.bottomRightCorner<3, 3>() * ray);
  evidence->squares[kTilt] += turn.squaredNorm() - std::pow(normal.dot(turn), 2);
  evidence->traces[kTilt] += P_turn.trace() - normal.dot(P_turn * normal);
}

void AddOutline(const LikelihoodPose& pose,
                const LikelihoodState& state,
                std::size_t index,
                const BoardPosterior& board,
                const LikelihoodNoise& noise,
                Evidence* evidence) {
  const OutlineDifference outline = OutlineDifferenceAt(pose, state, index);
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_shared =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, board.by_shared.cols());
  by_shared.leftCols<6>() = outline.J.leftCols<6>();
  by_shared.middleCols<kFirstRing>(kExtrinsicSize) = outline.J.rightCols<kFirstRing>();
  const Left<3> left(outline.residual,
                     outline.J.middleCols<6>(kBoardIndex),
                     by_shared,
                     OutlineCovariance(pose, noise).inverse(),
                     board);
  // The scan lines' errors are among the faults: what is left across the ray is alike both ways.
  evidence->squares[kAcrossRay] += left.Pr.head<2>().squaredNorm();
  evidence->traces[kAcrossRay] += left.P.topLeftCorner<2, 2>().trace();
  evidence->squares[kTurn] += left.Pr[2] * left.Pr[2];
  evidence->traces[kTurn] += left.P(2, 2);
}

// One step, as in FitWithErrors, the prior counting as a tenth of an observation: it keeps few
// poses from a variance of zero. The outlines' robust weights are in the posteriors alone: gross
// errors were left out before (FindOutlying), and a trace that they turn negative counts as none.
Variances Step(const std::vector<LikelihoodPose>& poses,
               const LikelihoodState& state,
               const std::vector<PoseEquations>& returns,
               const Eigen::VectorXd& prior_information,
               const Variances& prior,
               const LikelihoodNoise& noise) {
  SharedEquations equations = Eliminate(poses, state, noise, returns);
  const Eigen::Index num_faults = state.faults.size();
  equations.information.diagonal().tail(num_faults) += prior_information;
  equations.pull.tail(num_faults) -= prior_information.cwiseProduct(state.faults);
  SharedPosterior shared;
  shared.covariance = equations.information.inverse();
  shared.step = shared.covariance * equations.pull;
  Evidence evidence;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardPosterior board(equations.poses[i], shared);
    AddChessboard(poses[i], state, i, board, noise, &evidence);
    AddOutline(poses[i], state, i, board, noise, &evidence);
  }
  constexpr double kPriorWeight = 0.1;
  const Variances v = VariancesOf(noise);
  Variances next{};
  for (std::size_t k = 0; k < v.size(); ++k) {
    next[k] = std::sqrt((v[k] * v[k] * evidence.squares[k] + kPriorWeight * prior[k]) /
                        (std::max(evidence.traces[k], 0.0) + kPriorWeight / v[k]));
  }
  return next;
}

double MedianNoise(const std::vector<LikelihoodPose>& poses,
                   const LikelihoodState& state,
                   double current_m) {
  constexpr double kMedianToSigma = 1.4826;
  constexpr double kLeastRangeSigmaM = 1e-4;  // keeps noiseless data solvable
  std::vector<double> residuals_m;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardAndLidar at = state.At(i);
    for (const BoardReturn& seen : poses[i].returns) {
      const double range_m = RangeToBoardM(at, seen.direction_lidar, nullptr);
      residuals_m.push_back(std::abs(seen.range_m - state.OffsetM(seen) - range_m));
    }
  }
  if (residuals_m.empty()) return current_m;
  return std::max(kMedianToSigma * Median(residuals_m), kLeastRangeSigmaM);
}

}  // namespace

LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const Eigen::VectorXd& prior_information,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current) {
  constexpr int kSteps = 20;
  LikelihoodNoise noise = current;
  noise.range_m = MedianNoise(poses, state, current.range_m);
  std::vector<PoseEquations> returns;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    returns.push_back(EquationsOfReturns(poses[i], state, i, noise.range_m));
  }
  const Variances prior = PriorVariances(options);
  for (int i = 0; i < kSteps; ++i) {
    SetVariances(Step(poses, state, returns, prior_information, prior, noise), &noise);
  }
  return noise;
}

}  // namespace voqcal
