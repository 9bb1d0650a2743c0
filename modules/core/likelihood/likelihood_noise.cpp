#include "core/likelihood/likelihood_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/median.hpp"

namespace voqcal {
namespace {

SightingErrors PriorErrors(const LikelihoodOptions& options) {
  return {options.camera_error_m,
          options.outline_error_m,
          options.camera_error_rad,
          options.outline_error_rad};
}

// r'P U P r and tr(P U) of each variance's unit U, with the names of FitWithErrors.
struct Evidence {
  SightingVariances squares{};
  SightingVariances traces{};
};

void AddChessboard(const LikelihoodPose& pose,
                   const LikelihoodState& state,
                   std::size_t index,
                   const PoseShare& share,
                   const Eigen::VectorXd& shared_step,
                   const Eigen::MatrixXd& shared_covariance,
                   const LikelihoodNoise& noise,
                   Evidence* evidence) {
  // r = r0 + board - S l, of which the board follows the shared unknowns.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_shared =
      -share.board_covariance * share.to_board.transpose();
  if (state.num_lens > 0) by_shared.rightCols(state.num_lens) -= pose.lens.board_by_lens;
  const Vector6d residual = DifferenceLeft(state.ByChessboard(pose), state.T_camera_board[index]) +
                            share.board_covariance * share.board_pull + by_shared * shared_step;
  const Matrix6d posterior =
      share.board_covariance + by_shared * shared_covariance * by_shared.transpose();
  const Matrix6d W = CameraCovariance(pose, noise).inverse();
  const Vector6d Pr = W * residual;
  const Matrix6d P = W - W * posterior * W;
  const Eigen::Vector3d ray = pose.T_camera_board.translation().normalized();
  const Eigen::Vector3d normal = pose.T_camera_board.linear().col(2);
  const Eigen::Matrix3d P_turn = P.topLeftCorner<3, 3>();
  const Eigen::Matrix3d P_move = P.bottomRightCorner<3, 3>();
  evidence->squares[0] += std::pow(ray.dot(Pr.tail<3>()), 2);
  evidence->traces[0] += ray.dot(P_move * ray);
  evidence->squares[2] += Pr.head<3>().squaredNorm() - std::pow(normal.dot(Pr.head<3>()), 2);
  evidence->traces[2] += P_turn.trace() - normal.dot(P_turn * normal);
}

void AddOutline(const LikelihoodPose& pose,
                const LikelihoodState& state,
                std::size_t index,
                const PoseShare& share,
                const Eigen::VectorXd& shared_step,
                const Eigen::MatrixXd& shared_covariance,
                const LikelihoodNoise& noise,
                Evidence* evidence) {
  const OutlineDifference outline = OutlineDifferenceAt(pose, state, index);
  const Eigen::Matrix<double, 3, 6> J_board = outline.J.middleCols<6>(kBoardIndex);
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_shared =
      -J_board * share.board_covariance * share.to_board.transpose();
  by_shared.leftCols<6>() += outline.J.leftCols<6>();
  by_shared.middleCols<kFirstRing>(kExtrinsicSize) += outline.J.rightCols<kFirstRing>();
  const Eigen::Vector3d residual = outline.residual +
                                   J_board * (share.board_covariance * share.board_pull) +
                                   by_shared * shared_step;
  const Eigen::Matrix3d posterior = J_board * share.board_covariance * J_board.transpose() +
                                    by_shared * shared_covariance * by_shared.transpose();
  const Eigen::Matrix3d W = OutlineCovariance(pose, noise).inverse();
  const Eigen::Vector3d Pr = W * residual;
  const Eigen::Matrix3d P = W - W * posterior * W;
  evidence->squares[1] += Pr.head<2>().squaredNorm();
  evidence->traces[1] += P.topLeftCorner<2, 2>().trace();
  evidence->squares[3] += Pr[2] * Pr[2];
  evidence->traces[3] += P(2, 2);
}

// One step, as in FitWithErrors, the prior counting as a tenth of an observation: it keeps few
// poses from a variance of zero. The posteriors come from the same equations as the estimates:
// P = W - W Post W, of what is left of a sighting once all unknowns follow the data.
SightingVariances Step(const std::vector<LikelihoodPose>& poses,
                       const LikelihoodState& state,
                       const std::vector<PoseEquations>& returns,
                       const Eigen::VectorXd& prior_information,
                       const SightingVariances& prior,
                       const LikelihoodNoise& noise) {
  SharedEquations equations = Eliminate(poses, state, noise, returns);
  const Eigen::Index num_faults = state.faults_m.size();
  equations.information.diagonal().tail(num_faults) += prior_information;
  equations.pull.tail(num_faults) -= prior_information.cwiseProduct(state.faults_m);
  const Eigen::MatrixXd covariance = equations.information.inverse();
  const Eigen::VectorXd step = covariance * equations.pull;
  Evidence evidence;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PoseShare& share = equations.poses[i];
    AddChessboard(poses[i], state, i, share, step, covariance, noise, &evidence);
    AddOutline(poses[i], state, i, share, step, covariance, noise, &evidence);
  }
  constexpr double kPriorWeight = 0.1;
  const SightingVariances v = SquaresOf(noise.errors);
  SightingVariances next{};
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
  const SightingVariances prior = SquaresOf(PriorErrors(options));
  for (int i = 0; i < kSteps; ++i) {
    noise.errors = RootsOf(Step(poses, state, returns, prior_information, prior, noise));
  }
  return noise;
}

}  // namespace voqcal
