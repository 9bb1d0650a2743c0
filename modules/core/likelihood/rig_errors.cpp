#include "core/likelihood/rig_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "core/likelihood/camera_faults.hpp"
#include "core/likelihood/likelihood_search.hpp"
#include "core/likelihood/likelihood_terms.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

using RigErrorMatrix = Eigen::Matrix<double, kNumRigErrors, kNumRigErrors>;

// The rig file's errors, and after them the chessboards' turn, which is unknown as it was in the
// refinement.
constexpr Eigen::Index kNumUnknowns = kNumRigErrors + kNumChessboardTurns;

// How a chessboard's pose follows the lens, and what its corners tell of that. Of a sample without
// pixels (a table's) the pose follows as if they had been seen, but they tell nothing.
CameraFaultTerms LensTerms(const BoardSample& sample,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           double corner_error_px) {
  constexpr double kAnyPrior = 1.0;
  if (!sample.camera.corners_px.empty()) {
    return LensErrorTerms(sample, board, camera, kAnyPrior, corner_error_px);
  }
  BoardSample as_if_seen;
  as_if_seen.camera = sample.camera;
  const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
  for (const Eigen::Vector3d& corner_m : board.InnerCornersBoardM()) {
    as_if_seen.camera.corners_px.emplace_back(
        camera.Project(Eigen::Vector3d(T_camera_board * corner_m)));
  }
  CameraFaultTerms terms = LensErrorTerms(as_if_seen, board, camera, kAnyPrior, corner_error_px);
  terms.information.setZero();
  terms.pull.setZero();
  return terms;
}

// A larger board is as much farther away; the plate lies where the pattern puts it.
CameraFaultTerms RigErrorTerms(const BoardSample& sample,
                               const BoardSpec& board,
                               const CameraModel& camera,
                               const RigErrors& sigma,
                               double corner_error_px) {
  const CameraFaultTerms of_lens = LensTerms(sample, board, camera, corner_error_px);
  const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
  const CameraFaultTerms of_turn = ChessboardTurnTerms();
  CameraFaultTerms terms;
  terms.board_by_faults.setZero(6, kNumUnknowns);
  terms.board_by_faults.leftCols<kNumLensErrors>() = of_lens.board_by_faults;
  terms.board_by_faults.col(kSquares).tail<3>() = T_camera_board.translation();
  terms.board_by_faults.block<3, 2>(3, kPatternOffsetX) = -T_camera_board.linear().leftCols<2>();
  terms.board_by_faults.rightCols<kNumChessboardTurns>() = of_turn.board_by_faults;
  terms.information.setZero(kNumUnknowns, kNumUnknowns);
  terms.information.topLeftCorner<kNumLensErrors, kNumLensErrors>() = of_lens.information;
  terms.pull.setZero(kNumUnknowns);
  terms.pull.head<kNumLensErrors>() = of_lens.pull;
  terms.prior_sigmas.resize(kNumUnknowns);
  terms.prior_sigmas << sigma, of_turn.prior_sigmas;
  return terms;
}

std::vector<LikelihoodPose> PosesWithRigErrors(const std::vector<const BoardSample*>& samples,
                                               const BoardSpec& board,
                                               const CameraModel& camera,
                                               const LikelihoodExtrinsic& refined,
                                               const RigErrors& sigma,
                                               double corner_error_px) {
  std::vector<LikelihoodPose> poses;
  for (const BoardSample* sample : samples) {
    poses.push_back(MakeLikelihoodPose(*sample, refined.bias.shades, refined.T_camera_lidar));
    poses.back().camera_faults = RigErrorTerms(*sample, board, camera, sigma, corner_error_px);
  }
  return poses;
}

CameraFaultEstimates AllFree() {
  CameraFaultEstimates faults;
  faults.values.setZero(kNumUnknowns);
  faults.is_observable.assign(kNumUnknowns, true);
  return faults;
}

// P + m m' by what the data say of the errors (information, and pull at zero) and a prior
// N(0, t^2 sigma^2). The scales t, one of the lens' errors and one of the board's, are the
// likeliest, by expectation maximisation (Dempster, Laird and Rubin 1977, "Maximum likelihood from
// incomplete data via the EM algorithm", Journal of the Royal Statistical Society B 39), but at
// least 1: few boards may say nothing.
RigErrorMatrix MeanSquareOf(const RigErrorMatrix& information,
                            const RigErrors& pull,
                            const RigErrors& sigma) {
  constexpr int kMaxRounds = 200;  // it nears its end ever more slowly, from below
  constexpr double kSettledRatio = 1e-3;
  constexpr Eigen::Index kNumBoardErrors = kNumRigErrors - kNumLensErrors;
  RigErrors t2 = RigErrors::Ones();
  RigErrorMatrix mean_square;
  for (int round = 0; round < kMaxRounds; ++round) {
    const RigErrors prior = t2.cwiseProduct(sigma.cwiseAbs2()).cwiseInverse();
    const RigErrorMatrix P = (information + RigErrorMatrix(prior.asDiagonal())).inverse();
    const RigErrors m = P * pull;
    mean_square = P + m * m.transpose();
    const RigErrors before = t2;
    const RigErrors found = mean_square.diagonal().cwiseQuotient(sigma.cwiseAbs2());
    t2.head<kNumLensErrors>().setConstant(std::max(1.0, found.head<kNumLensErrors>().mean()));
    t2.tail<kNumBoardErrors>().setConstant(std::max(1.0, found.tail<kNumBoardErrors>().mean()));
    if ((t2 - before).cwiseAbs().cwiseQuotient(before).maxCoeff() < kSettledRatio) break;
  }
  return mean_square;
}

}  // namespace

RigErrors PlausibleRigErrors(const LikelihoodOptions& options) {
  RigErrors sigma;
  sigma.head<kNumLensErrors>().setConstant(options.lens_error);
  sigma[kSquares] = options.board_size_error;
  sigma[kPatternOffsetX] = options.pattern_offset_error_m;
  sigma[kPatternOffsetY] = options.pattern_offset_error_m;
  return sigma;
}

Matrix6d CovarianceByRigErrors(const std::vector<const BoardSample*>& samples,
                               const BoardSpec& board,
                               const CameraModel& camera,
                               const LikelihoodExtrinsic& refined,
                               const LikelihoodOptions& options) {
  constexpr double kLeastPrior = 1e-9;  // the search needs one
  constexpr double kSettled = 1e-6;     // radians or metres
  RequireUsable("LikelihoodOptions", options.Problems());
  const RigErrors sigma = PlausibleRigErrors(options).cwiseMax(kLeastPrior);
  LikelihoodSearch search(
      PosesWithRigErrors(samples, board, camera, refined, sigma, options.corner_error_px),
      refined.T_camera_lidar,
      options);
  search.StartFrom(refined.bias, AllFree(), refined.noise);
  if (!search.Minimise(options.max_iterations, kSettled) || !search.IsPhysical()) {
    return Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const Eigen::MatrixXd gain = search.Gain(search.Equations().information);
  const Eigen::Index first = gain.rows() - kNumUnknowns;
  const RigErrorMatrix with_prior =
      gain.block<kNumRigErrors, kNumRigErrors>(first, first).inverse();
  const RigErrorMatrix of_data =
      with_prior - RigErrorMatrix(sigma.cwiseAbs2().cwiseInverse().asDiagonal());
  const Eigen::Matrix<double, 6, kNumRigErrors> J =
      gain.block<6, kNumRigErrors>(0, first) * with_prior;
  const RigErrors pull = with_prior * search.state().CameraFaults().head<kNumRigErrors>();
  const Matrix6d covariance = J * MeanSquareOf(of_data, pull, sigma) * J.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace voqcal
