#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/likelihood/likelihood_estimate.hpp"
#include "core/likelihood/likelihood_options.hpp"
#include "core/likelihood/likelihood_terms.hpp"

namespace voqcal {

/// The shared unknowns: [extrinsic's perturbation (6); faults]. The faults are the lidar's, in this
/// order, each scan line's from kFirstRing on, and after them the camera's, which the poses'
/// CameraFaultTerms ask for.
constexpr Eigen::Index kExtrinsicSize = 6;
constexpr Eigen::Index kCommon = 0;
constexpr Eigen::Index kDarkStep = 1;
constexpr Eigen::Index kLift = 2;
constexpr Eigen::Index kRise = 3;
constexpr Eigen::Index kFirstRing = 4;

/// Where the search stands.
struct LikelihoodState {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// The lidar's: metres, of the rise metres a metre; the camera's: shares of LensErrors, or
  /// radians of the chessboards' turn.
  Eigen::VectorXd faults;
  Eigen::Index num_camera_faults = 0;
  std::vector<Eigen::Isometry3d> T_camera_board;

  Eigen::Index NumLidarFaults() const { return faults.size() - num_camera_faults; }
  Eigen::Index NumRings() const { return NumLidarFaults() - kFirstRing; }
  Eigen::VectorXd CameraFaults() const { return faults.tail(num_camera_faults); }
  /// Where the chessboard's pixels put the board, with the camera's faults as they are.
  Eigen::Isometry3d ByChessboard(const LikelihoodPose& pose) const {
    if (num_camera_faults == 0) return pose.T_camera_board;
    return PerturbLeft(pose.T_camera_board, pose.camera_faults.board_by_faults * CameraFaults());
  }
  double OffsetM(const BoardReturn& seen) const {
    return faults[kCommon] + faults[kDarkStep] * seen.shade +
           faults[kFirstRing + static_cast<Eigen::Index>(seen.ring)];
  }
  double LiftM(const OutlineRays& outline) const {
    return faults[kLift] + faults[kRise] * outline.T_lidar_board.translation().norm();
  }
  BoardAndLidar At(std::size_t pose) const { return {T_camera_lidar, T_camera_board[pose]}; }
};

constexpr Eigen::Index kBoardIndex = 6;  ///< Of a pose's unknowns: [extrinsic 6; board 6; faults].

/// Gauss-Newton's equations of one pose.
struct PoseEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;  ///< Minus the gradient.
};

/// What the returns of one pose say at `state`, with Cauchy weights, which give way to gross
/// errors.
PoseEquations EquationsOfReturns(const LikelihoodPose& pose,
                                 const LikelihoodState& state,
                                 std::size_t index,
                                 double range_sigma_m);

/// The outline's residual, and its derivative by a pose's unknowns but the rings and the
/// camera's faults.
struct OutlineDifference {
  Eigen::Vector3d residual;
  Eigen::Matrix<double, 3, 12 + kFirstRing> J;
};
OutlineDifference OutlineDifferenceAt(const LikelihoodPose& pose,
                                      const LikelihoodState& state,
                                      std::size_t index);

/// Adds what outline (with Cauchy weights too) and chessboard say to what the returns do.
void AddBoard(const LikelihoodPose& pose,
              const LikelihoodState& state,
              std::size_t index,
              const LikelihoodNoise& noise,
              PoseEquations* equations);

/// One pose with its board's unknowns eliminated (Schur complement).
struct PoseShare {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
  Eigen::Matrix<double, Eigen::Dynamic, 6> to_board;  ///< Information, shared unknowns by board's.
  Matrix6d board_covariance;                          ///< With the shared unknowns known.
  Vector6d board_pull;

  /// The step of the board's pose that follows from `shared_step`.
  Vector6d BoardStep(const Eigen::VectorXd& shared_step) const;
};

/// The sum over all poses, without the faults' priors.
struct SharedEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd pull;
  std::vector<PoseShare> poses;
};
SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodNoise& noise);

/// The same with the returns' equations at `state` at hand: they depend on no sighting's errors.
SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodNoise& noise,
                          const std::vector<PoseEquations>& returns);

/// The detectors' covariances with the sightings' errors: depth and tilt are the chessboard's...
Matrix6d CameraCovariance(const LikelihoodPose& pose, const LikelihoodNoise& noise);
/// ...across and turn the outline's.
Eigen::Matrix3d OutlineCovariance(const LikelihoodPose& pose, const LikelihoodNoise& noise);

}  // namespace voqcal
