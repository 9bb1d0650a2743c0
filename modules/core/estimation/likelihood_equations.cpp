#include "core/estimation/likelihood_equations.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace voqcal {
namespace {

constexpr Eigen::Index kBoardIndex = 6;        // of a pose's unknowns
constexpr Eigen::Index kPoseFaultsIndex = 12;  // common, dark step, rings
constexpr Eigen::Index kNumDense = 14;         // all but the rings: each return has one ring
constexpr double kCauchyWidth = 2.385;         // 95 % efficient on normal noise

// IRLS weight of Cauchy's loss; `squared` is the whitened residual's square for each dimension.
double CauchyWeight(double squared) {
  return 1.0 / (1.0 + squared / (kCauchyWidth * kCauchyWidth));
}

void AddReturns(const LikelihoodPose& pose,
                const LikelihoodState& state,
                std::size_t index,
                double range_sigma_m,
                PoseEquations* equations) {
  const BoardAndLidar at = state.At(index);
  const double information = 1.0 / (range_sigma_m * range_sigma_m);
  for (const BoardReturn& seen : pose.returns) {
    Vector12d J_range;
    const double range_m = RangeToBoardM(at, seen.direction_lidar, &J_range);
    const double residual_m = seen.range_m - state.OffsetM(seen) - range_m;
    const double weight = information * CauchyWeight(residual_m * residual_m * information);
    Eigen::Matrix<double, kNumDense, 1> J;
    J << J_range, 1.0, seen.shade;
    const Eigen::Matrix<double, kNumDense, 1> weighted = weight * J;
    const Eigen::Index ring = kNumDense + static_cast<Eigen::Index>(seen.ring);
    equations->information.topLeftCorner<kNumDense, kNumDense>().noalias() +=
        weighted * J.transpose();
    equations->information.col(ring).head<kNumDense>() += weighted;
    equations->information(ring, ring) += weight;
    equations->pull.head<kNumDense>() += residual_m * weighted;
    equations->pull[ring] += residual_m * weight;
  }
  const Eigen::Index num_rings = equations->pull.size() - kNumDense;
  equations->information.bottomLeftCorner(num_rings, kNumDense) =
      equations->information.topRightCorner(kNumDense, num_rings).transpose();
}

void AddOutline(const LikelihoodPose& pose,
                const BoardAndLidar& at,
                const Eigen::Matrix3d& covariance,
                PoseEquations* equations) {
  Matrix312d J;
  const Eigen::Vector3d residual = OutlineResidual(at, pose.outline, &J);
  const Eigen::Matrix3d information = covariance.inverse();
  const Eigen::Matrix3d weight =
      CauchyWeight(residual.dot(information * residual) / 3.0) * information;
  equations->information.topLeftCorner<12, 12>() += J.transpose() * weight * J;
  equations->pull.head<12>() -= J.transpose() * (weight * residual);
}

// The difference's derivative by the perturbation is taken as identity: they differ by half the
// tilt from the chessboard's pose, thousandths of a radian.
void AddChessboard(const LikelihoodPose& pose,
                   const Eigen::Isometry3d& T_camera_board,
                   const Matrix6d& covariance,
                   PoseEquations* equations) {
  const Matrix6d information = covariance.inverse();
  equations->information.block<6, 6>(kBoardIndex, kBoardIndex) += information;
  equations->pull.segment<6>(kBoardIndex) -=
      information * DifferenceLeft(pose.T_camera_board, T_camera_board);
}

// The rows of a pose's unknowns that are shared.
Eigen::MatrixXd SharedRows(const Eigen::MatrixXd& pose_rows) {
  const Eigen::Index num_faults = pose_rows.rows() - kPoseFaultsIndex;
  Eigen::MatrixXd shared(kExtrinsicSize + num_faults, pose_rows.cols());
  shared << pose_rows.topRows(kExtrinsicSize), pose_rows.bottomRows(num_faults);
  return shared;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How far the outline's rays are from the chessboard's pose, in squared standard deviations of what
// both claim.
double OutlineDisagreement(const LikelihoodPose& pose,
                           const LikelihoodState& state,
                           const LikelihoodOptions& options,
                           const LikelihoodNoise& noise) {
  Matrix312d J;
  const Eigen::Vector3d difference =
      OutlineResidual({state.T_camera_lidar, pose.T_camera_board}, pose.outline, &J);
  const Eigen::Matrix<double, 3, 6> J_board = J.rightCols<6>();
  const Eigen::Matrix3d expected =
      OutlineCovariance(pose, options, noise) +
      J_board * CameraCovariance(pose, options, noise) * J_board.transpose();
  return difference.dot(expected.inverse() * difference);
}

// How far the lidar's plane (tilts and offset) lies from the chessboard's, in squared standard
// deviations of what both claim.
double PlaneDisagreement(const LikelihoodPose& pose,
                         const LikelihoodState& state,
                         std::size_t index,
                         const LikelihoodOptions& options,
                         const LikelihoodNoise& noise) {
  LikelihoodState by_camera = state;
  by_camera.T_camera_board[index] = pose.T_camera_board;
  const Eigen::Index num_unknowns = kPoseFaultsIndex + state.faults_m.size();
  PoseEquations returns{Eigen::MatrixXd::Zero(num_unknowns, num_unknowns),
                        Eigen::VectorXd::Zero(num_unknowns)};
  AddReturns(pose, by_camera, index, noise.range_m, &returns);
  const Eigen::Matrix3d R = pose.T_camera_board.linear();
  Eigen::Matrix<double, 6, 3> plane = Eigen::Matrix<double, 6, 3>::Zero();
  plane.block<3, 2>(0, 0) = R.leftCols<2>();
  plane.block<3, 1>(3, 2) = R.col(2);
  const Eigen::Matrix3d information =
      plane.transpose() * returns.information.block<6, 6>(kBoardIndex, kBoardIndex) * plane;
  const Eigen::Matrix3d covariance = information.inverse();
  const Eigen::Vector3d difference =
      covariance * (plane.transpose() * returns.pull.segment<6>(kBoardIndex));
  const Eigen::Matrix3d expected =
      covariance + plane.transpose() * CameraCovariance(pose, options, noise) * plane;
  return difference.dot(expected.inverse() * difference);
}

}  // namespace

Matrix6d CameraCovariance(const LikelihoodPose& pose,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise) {
  constexpr double kLeastAcrossM = 1e-4;  // keeps a covariance that is unknown (zero) regular
  Matrix6d covariance = pose.covariance;
  covariance.diagonal().head<3>().array() += options.camera_error_rad * options.camera_error_rad;
  // Along the ray: across it the pixels hold the board.
  const Eigen::Vector3d ray = pose.T_camera_board.translation().normalized();
  covariance.bottomRightCorner<3, 3>() +=
      options.camera_error_m * options.camera_error_m * ray * ray.transpose();
  covariance.bottomRightCorner<3, 3>().diagonal().array() += kLeastAcrossM * kLeastAcrossM;
  return noise.camera_factor * noise.camera_factor * covariance;
}

Eigen::Matrix3d OutlineCovariance(const LikelihoodPose& pose,
                                  const LikelihoodOptions& options,
                                  const LikelihoodNoise& noise) {
  Eigen::Matrix3d covariance = pose.outline.covariance;
  covariance(0, 0) += options.outline_error_m * options.outline_error_m;
  covariance(1, 1) += options.outline_error_m * options.outline_error_m;
  covariance(2, 2) += options.outline_error_rad * options.outline_error_rad;
  return noise.outline_factor * noise.outline_factor * covariance;
}

PoseEquations EquationsOf(const LikelihoodPose& pose,
                          const LikelihoodState& state,
                          std::size_t index,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise) {
  const Eigen::Index num_unknowns = kPoseFaultsIndex + state.faults_m.size();
  PoseEquations equations{Eigen::MatrixXd::Zero(num_unknowns, num_unknowns),
                          Eigen::VectorXd::Zero(num_unknowns)};
  AddReturns(pose, state, index, noise.range_m, &equations);
  AddOutline(pose, state.At(index), OutlineCovariance(pose, options, noise), &equations);
  AddChessboard(
      pose, state.T_camera_board[index], CameraCovariance(pose, options, noise), &equations);
  return equations;
}

SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodOptions& options,
                          const LikelihoodNoise& noise) {
  const Eigen::Index num_shared = kExtrinsicSize + state.faults_m.size();
  SharedEquations shared{
      Eigen::MatrixXd::Zero(num_shared, num_shared), Eigen::VectorXd::Zero(num_shared), {}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    shared.poses.push_back(EquationsOf(poses[i], state, i, options, noise));
    const PoseEquations& pose = shared.poses.back();
    const Matrix6d board_covariance =
        pose.information.block<6, 6>(kBoardIndex, kBoardIndex).inverse();
    const Eigen::MatrixXd to_board = SharedRows(pose.information.middleCols<6>(kBoardIndex));
    const Eigen::MatrixXd gain = to_board * board_covariance;
    shared.information +=
        SharedRows(SharedRows(pose.information).transpose()) - gain * to_board.transpose();
    shared.pull += SharedRows(pose.pull) - gain * pose.pull.segment<6>(kBoardIndex);
  }
  return shared;
}

Vector6d BoardStep(const PoseEquations& equations, const Eigen::VectorXd& shared_step) {
  const Eigen::MatrixXd to_board = SharedRows(equations.information.middleCols<6>(kBoardIndex));
  const Matrix6d information = equations.information.block<6, 6>(kBoardIndex, kBoardIndex);
  return information.ldlt().solve(equations.pull.segment<6>(kBoardIndex) -
                                  to_board.transpose() * shared_step);
}

LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current) {
  constexpr double kMedianToSigma = 1.4826;
  constexpr double kMedianChiSquared3 = 2.366;
  constexpr std::size_t kMinReturns = 30;     // a plane needs some
  constexpr double kLeastRangeSigmaM = 1e-4;  // keeps noiseless data solvable
  // Outline and planes that contradict each other could otherwise explain one another away: the
  // factor of the one grows, the fit turns to the other, and the factor grows more.
  constexpr double kLeastFactor = 0.5;
  constexpr double kLargestFactor = 2.0;
  std::vector<double> ranges, outlines, planes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardAndLidar at = state.At(i);
    for (const BoardReturn& seen : poses[i].returns) {
      const double range_m = RangeToBoardM(at, seen.direction_lidar, nullptr);
      ranges.push_back(std::abs(seen.range_m - state.OffsetM(seen) - range_m));
    }
    outlines.push_back(OutlineDisagreement(poses[i], state, options, current));
    if (poses[i].returns.size() < kMinReturns) continue;
    planes.push_back(PlaneDisagreement(poses[i], state, i, options, current));
  }
  // Three residuals a pose, and six unknowns that bend towards them.
  const double num = static_cast<double>(poses.size());
  const double freedom = num / std::max(num - 2.0, 1.0);
  LikelihoodNoise noise = current;
  if (!ranges.empty()) noise.range_m = std::max(kMedianToSigma * Median(ranges), kLeastRangeSigmaM);
  noise.outline_factor *= std::sqrt(freedom * Median(outlines) / kMedianChiSquared3);
  noise.outline_factor = std::clamp(noise.outline_factor, kLeastFactor, kLargestFactor);
  if (!planes.empty()) noise.camera_factor *= std::sqrt(Median(planes) / kMedianChiSquared3);
  noise.camera_factor = std::clamp(noise.camera_factor, kLeastFactor, kLargestFactor);
  return noise;
}

}  // namespace voqcal
