#include "core/likelihood/likelihood_equations.hpp"

#include <Eigen/LU>

namespace voqcal {
namespace {

constexpr Eigen::Index kPoseFaultsIndex = 12;  // common, dark step, lift, rise; then the rings
constexpr Eigen::Index kNumDense = kPoseFaultsIndex + kFirstRing;  // all but the rings
constexpr Eigen::Index kNumSeen = 5;                               // of a pose, by its returns
constexpr double kCauchyWidth = 2.385;                             // 95 % efficient on normal noise

// IRLS weight of Cauchy's loss; `squared` is the whitened residual's square for each dimension.
double CauchyWeight(double squared) {
  return 1.0 / (1.0 + squared / (kCauchyWidth * kCauchyWidth));
}

// What the returns of one pose say of [plane in the lidar frame (3); common; dark step], of their
// rings' offsets, and of both together.
struct ReturnSums {
  Eigen::Matrix<double, kNumSeen, kNumSeen> information;
  Eigen::Matrix<double, kNumSeen, Eigen::Dynamic> to_rings;
  Eigen::VectorXd ring_information;
  Eigen::Matrix<double, kNumSeen, 1> pull;
  Eigen::VectorXd ring_pull;
};

ReturnSums SumReturns(const LikelihoodPose& pose,
                      const LikelihoodState& state,
                      const Eigen::Vector3d& plane,
                      double range_sigma_m) {
  const Eigen::Index num_rings = state.NumRings();
  ReturnSums sums;
  sums.information.setZero();
  sums.to_rings.setZero(kNumSeen, num_rings);
  sums.ring_information.setZero(num_rings);
  sums.pull.setZero();
  sums.ring_pull.setZero(num_rings);
  const double information = 1.0 / (range_sigma_m * range_sigma_m);
  for (const BoardReturn& seen : pose.returns) {
    const double range_m = 1.0 / plane.dot(seen.direction_lidar);
    const double residual_m = seen.range_m - state.OffsetM(seen) - range_m;
    const double weight = information * CauchyWeight(residual_m * residual_m * information);
    Eigen::Matrix<double, kNumSeen, 1> J;
    J << -range_m * range_m * seen.direction_lidar, 1.0, seen.shade;
    const Eigen::Matrix<double, kNumSeen, 1> weighted = weight * J;
    const auto ring = static_cast<Eigen::Index>(seen.ring);
    sums.information.noalias() += weighted * J.transpose();
    sums.to_rings.col(ring) += weighted;
    sums.ring_information[ring] += weight;
    sums.pull += residual_m * weighted;
    sums.ring_pull[ring] += residual_m * weight;
  }
  return sums;
}

void AddOutline(const OutlineDifference& outline,
                const Eigen::Matrix3d& covariance,
                PoseEquations* equations) {
  const auto& [residual, J] = outline;
  const Eigen::Matrix3d information = covariance.inverse();
  const Eigen::Matrix3d weight =
      CauchyWeight(residual.dot(information * residual) / 3.0) * information;
  equations->information.topLeftCorner<kNumDense, kNumDense>() += J.transpose() * weight * J;
  equations->pull.head<kNumDense>() -= J.transpose() * (weight * residual);
}

// How far the board is from where the chessboard's pixels put it, and what they say of
// the camera's faults l:
//     r = (T_camera_board - its pose by the chessboard) - S l
// with the names of CameraFaultTerms. The difference's derivative by the perturbation is taken as
// identity: they differ by half the tilt from the chessboard's pose, thousandths of a radian.
void AddChessboard(const LikelihoodPose& pose,
                   const LikelihoodState& state,
                   std::size_t index,
                   const Matrix6d& covariance,
                   PoseEquations* equations) {
  const Matrix6d information = covariance.inverse();
  const Vector6d weighted =
      information * DifferenceLeft(state.ByChessboard(pose), state.T_camera_board[index]);
  equations->information.block<6, 6>(kBoardIndex, kBoardIndex) += information;
  equations->pull.segment<6>(kBoardIndex) -= weighted;
  const Eigen::Index n = state.num_camera_faults;
  if (n == 0) return;
  const CameraFaultTerms& terms = pose.camera_faults;
  const auto& S = terms.board_by_faults;
  const Eigen::Index first = equations->pull.size() - n;
  const Eigen::MatrixXd to_faults = information * S;
  equations->information.block(kBoardIndex, first, 6, n) -= to_faults;
  equations->information.block(first, kBoardIndex, n, 6) -= to_faults.transpose();
  equations->information.block(first, first, n, n) += S.transpose() * to_faults + terms.information;
  equations->pull.tail(n) +=
      S.transpose() * weighted + terms.pull - terms.information * state.CameraFaults();
}

// The rows of a pose's unknowns that are shared.
Eigen::MatrixXd SharedRows(const Eigen::MatrixXd& pose_rows) {
  const Eigen::Index num_faults = pose_rows.rows() - kPoseFaultsIndex;
  Eigen::MatrixXd shared(kExtrinsicSize + num_faults, pose_rows.cols());
  shared << pose_rows.topRows(kExtrinsicSize), pose_rows.bottomRows(num_faults);
  return shared;
}

PoseShare EliminateBoard(const PoseEquations& pose) {
  PoseShare share;
  share.board_covariance = pose.information.block<6, 6>(kBoardIndex, kBoardIndex).inverse();
  share.board_pull = pose.pull.segment<6>(kBoardIndex);
  share.to_board = SharedRows(pose.information.middleCols<6>(kBoardIndex));
  const Eigen::MatrixXd gain = share.to_board * share.board_covariance;
  share.information =
      SharedRows(SharedRows(pose.information).transpose()) - gain * share.to_board.transpose();
  share.pull = SharedRows(pose.pull) - gain * share.board_pull;
  return share;
}

}  // namespace

Matrix6d CameraCovariance(const LikelihoodPose& pose, const LikelihoodNoise& noise) {
  // Keep a covariance that is unknown (zero) regular.
  constexpr double kLeastAcrossM = 1e-4;
  constexpr double kLeastTurnRad = 1e-4;
  Matrix6d covariance = pose.covariance;
  covariance.diagonal().head<3>().array() += kLeastTurnRad * kLeastTurnRad;
  covariance.diagonal().tail<3>().array() += kLeastAcrossM * kLeastAcrossM;
  // Across the ray and about the normal the pixels hold the board.
  const Eigen::Vector3d ray = pose.T_camera_board.translation().normalized();
  const Eigen::Vector3d normal = pose.T_camera_board.linear().col(2);
  covariance.bottomRightCorner<3, 3>() +=
      noise.along_ray_m * noise.along_ray_m * ray * ray.transpose();
  covariance.topLeftCorner<3, 3>() +=
      noise.tilt_rad * noise.tilt_rad * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  return covariance;
}

Eigen::Matrix3d OutlineCovariance(const LikelihoodPose& pose, const LikelihoodNoise& noise) {
  Eigen::Matrix3d covariance = pose.outline.covariance;
  covariance.diagonal().head<2>().array() += noise.across_ray_m * noise.across_ray_m;
  covariance(2, 2) += noise.turn_rad * noise.turn_rad;
  return covariance;
}

OutlineDifference OutlineDifferenceAt(const LikelihoodPose& pose,
                                      const LikelihoodState& state,
                                      std::size_t index) {
  Matrix312d J_rigid;
  OutlineDifference outline;
  outline.residual =
      OutlineResidual(state.At(index), pose.outline, state.LiftM(pose.outline), &J_rigid);
  outline.J << J_rigid, Eigen::Matrix<double, 3, kFirstRing>::Zero();
  outline.J.col(kPoseFaultsIndex + kLift) = OutlineByLift(pose.outline);
  outline.J.col(kPoseFaultsIndex + kRise) =
      pose.outline.T_lidar_board.translation().norm() * outline.J.col(kPoseFaultsIndex + kLift);
  return outline;
}

PoseEquations EquationsOfReturns(const LikelihoodPose& pose,
                                 const LikelihoodState& state,
                                 std::size_t index,
                                 double range_sigma_m) {
  const Eigen::Index num_rings = state.NumRings();
  const Eigen::Index num_unknowns = kNumDense + num_rings + state.num_camera_faults;
  Matrix312d J_plane;
  const Eigen::Vector3d plane = PlaneInLidar(state.At(index), &J_plane);
  const ReturnSums sums = SumReturns(pose, state, plane, range_sigma_m);
  Eigen::Matrix<double, kNumDense, kNumSeen> expand =
      Eigen::Matrix<double, kNumDense, kNumSeen>::Zero();
  expand.topLeftCorner<12, 3>() = J_plane.transpose();
  expand(kPoseFaultsIndex + kCommon, 3) = 1.0;
  expand(kPoseFaultsIndex + kDarkStep, 4) = 1.0;
  PoseEquations equations{Eigen::MatrixXd::Zero(num_unknowns, num_unknowns),
                          Eigen::VectorXd::Zero(num_unknowns)};
  equations.information.topLeftCorner<kNumDense, kNumDense>() =
      expand * sums.information * expand.transpose();
  equations.information.block(0, kNumDense, kNumDense, num_rings) = expand * sums.to_rings;
  equations.information.block(kNumDense, 0, num_rings, kNumDense) =
      equations.information.block(0, kNumDense, kNumDense, num_rings).transpose();
  equations.information.diagonal().segment(kNumDense, num_rings) = sums.ring_information;
  equations.pull.head(kNumDense) = expand * sums.pull;
  equations.pull.segment(kNumDense, num_rings) = sums.ring_pull;
  return equations;
}

void AddBoard(const LikelihoodPose& pose,
              const LikelihoodState& state,
              std::size_t index,
              const LikelihoodNoise& noise,
              PoseEquations* equations) {
  AddOutline(OutlineDifferenceAt(pose, state, index), OutlineCovariance(pose, noise), equations);
  AddChessboard(pose, state, index, CameraCovariance(pose, noise), equations);
}

SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodNoise& noise) {
  std::vector<PoseEquations> returns;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    returns.push_back(EquationsOfReturns(poses[i], state, i, noise.range_m));
  }
  return Eliminate(poses, state, noise, returns);
}

SharedEquations Eliminate(const std::vector<LikelihoodPose>& poses,
                          const LikelihoodState& state,
                          const LikelihoodNoise& noise,
                          const std::vector<PoseEquations>& returns) {
  const Eigen::Index num_shared = kExtrinsicSize + state.faults.size();
  SharedEquations shared{
      Eigen::MatrixXd::Zero(num_shared, num_shared), Eigen::VectorXd::Zero(num_shared), {}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    PoseEquations equations = returns[i];
    AddBoard(poses[i], state, i, noise, &equations);
    shared.poses.push_back(EliminateBoard(equations));
    shared.information += shared.poses.back().information;
    shared.pull += shared.poses.back().pull;
  }
  return shared;
}

Vector6d PoseShare::BoardStep(const Eigen::VectorXd& shared_step) const {
  return board_covariance * (board_pull - to_board.transpose() * shared_step);
}

}  // namespace voqcal
