#include "core/likelihood/likelihood_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/median.hpp"

namespace voqcal {
namespace {

// How far the outline's rays are from the chessboard's pose, in squared standard deviations of what
// both claim.
double OutlineDisagreement(const LikelihoodPose& pose,
                           const LikelihoodState& state,
                           const LikelihoodOptions& options,
                           const LikelihoodNoise& noise) {
  Matrix312d J;
  const Eigen::Vector3d difference =
      OutlineResidual({state.T_camera_lidar, state.ByChessboard(pose)},
                      pose.outline,
                      state.LiftM(pose.outline),
                      &J);
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
  by_camera.T_camera_board[index] = state.ByChessboard(pose);
  const PoseEquations returns = EquationsOfReturns(pose, by_camera, index, noise.range_m);
  const Eigen::Matrix3d R = by_camera.T_camera_board[index].linear();
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

LikelihoodNoise EstimateNoise(const std::vector<LikelihoodPose>& poses,
                              const LikelihoodState& state,
                              const LikelihoodOptions& options,
                              const LikelihoodNoise& current) {
  constexpr double kMedianToSigma = 1.4826;
  constexpr double kMedianChiSquared3 = 2.366;
  constexpr std::size_t kMinReturns = 30;  // a plane needs some
  constexpr std::size_t kMinOutlines = 3;
  constexpr double kLeastRangeSigmaM = 1e-4;  // keeps noiseless data solvable
  // Outline and planes that contradict each other could otherwise explain one another away: the
  // factor of the one grows, the fit turns to the other, and the factor grows more.
  constexpr double kLeastFactor = 0.1;
  constexpr double kLargestFactor = 2.0;
  std::vector<double> ranges, outlines, planes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardAndLidar at = state.At(i);
    for (const BoardReturn& seen : poses[i].returns) {
      const double range_m = RangeToBoardM(at, seen.direction_lidar, nullptr);
      ranges.push_back(std::abs(seen.range_m - state.OffsetM(seen) - range_m));
    }
    if (poses[i].outline.is_whole) {
      outlines.push_back(OutlineDisagreement(poses[i], state, options, current));
    }
    if (poses[i].returns.size() < kMinReturns) continue;
    planes.push_back(PlaneDisagreement(poses[i], state, i, options, current));
  }
  // Three residuals a pose, and six unknowns that bend towards them.
  const double num = static_cast<double>(outlines.size());
  const double freedom = num / std::max(num - 2.0, 1.0);
  LikelihoodNoise noise = current;
  if (!ranges.empty()) noise.range_m = std::max(kMedianToSigma * Median(ranges), kLeastRangeSigmaM);
  if (outlines.size() >= kMinOutlines) {
    noise.outline_factor *= std::sqrt(freedom * Median(outlines) / kMedianChiSquared3);
  }
  noise.outline_factor = std::clamp(noise.outline_factor, kLeastFactor, kLargestFactor);
  if (!planes.empty()) noise.camera_factor *= std::sqrt(Median(planes) / kMedianChiSquared3);
  noise.camera_factor = std::clamp(noise.camera_factor, kLeastFactor, kLargestFactor);
  return noise;
}

}  // namespace voqcal
