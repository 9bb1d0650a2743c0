#include "core/likelihood/likelihood_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/camera/lens_errors.hpp"
#include "core/estimation/left_perturbation.hpp"

namespace voqcal {
namespace {

// The variance of Student's t over the normal's: few poses measure their own variety badly, and
// about three of them hold the extrinsic; the likelihood's noise levels are of as few. Six poses,
// 3; ten, 1.4; thirty, 1.08.
double FewPosesFactor(double num_poses) {
  constexpr double kLeastFreedom = 2.5;
  const double freedom = std::max(num_poses - 3.0, kLeastFreedom);
  return freedom / (freedom - 2.0);
}

Vector6d Resampled(const LikelihoodSearch& search,
                   const SharedEquations& equations,
                   const Eigen::MatrixXd& gain) {
  const auto num_poses = static_cast<Eigen::Index>(equations.poses.size());
  Eigen::Matrix<double, 6, Eigen::Dynamic> steps(6, num_poses);
  for (Eigen::Index i = 0; i < num_poses; ++i) {
    const PoseShare& out = equations.poses[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd gain_without = search.Gain(equations.information - out.information);
    steps.col(i) = gain_without.topRows<kExtrinsicSize>() * (equations.pull - out.pull);
  }
  const double num = static_cast<double>(num_poses);
  Vector6d variance =
      (num - 1.0) / num * (steps.colwise() - steps.rowwise().mean()).rowwise().squaredNorm();
  // What poses do not tell: how far the faults are from their priors' middle.
  for (Eigen::Index i = 0; i < search.state().faults.size(); ++i) {
    const Eigen::Index fault = kExtrinsicSize + i;
    const double information = search.prior_information()[i];
    const Eigen::VectorXd shift = search.IsFree(i) ? Eigen::VectorXd(information * gain.col(fault))
                                                   : gain * equations.information.col(fault);
    variance += shift.head<kExtrinsicSize>().cwiseAbs2() / information;
  }
  return variance.cwiseSqrt();
}

// How the pixel of a point moves under an error of the lens.
using PixelShift = std::function<Eigen::Vector2d(const Eigen::Vector2d& pixel_px)>;

// How a chessboard's pose answers, so that its points stay on their pixels. Four points stand for
// the corners; where they lie on the board hardly matters.
Vector6d BoardShift(const LikelihoodPose& pose,
                    const CameraModel& camera,
                    const PixelShift& shift_px) {
  constexpr double kPatternShare = 0.7;  // of the outline: about where the outer corners are
  const Eigen::Vector3d centre_m = pose.T_camera_board.translation();
  Matrix6d information = Matrix6d::Zero();
  Vector6d pull = Vector6d::Zero();
  for (const Eigen::Vector3d& corner_m : pose.corners_camera_m) {
    const Eigen::Vector3d arm_m = kPatternShare * (corner_m - centre_m);
    Matrix23d J_px_point;
    const Eigen::Vector2d pixel_px = ProjectWithJacobian(camera, centre_m + arm_m, &J_px_point);
    Matrix36d J_point;
    J_point << -Skew(arm_m), Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> J = J_px_point * J_point;
    information += J.transpose() * J;
    pull -= J.transpose() * shift_px(pixel_px);
  }
  return information.ldlt().solve(pull);
}

Vector6d ModelErrors(const LikelihoodSearch& search,
                     const SharedEquations& equations,
                     const Eigen::MatrixXd& gain,
                     const CameraModel& camera,
                     const LikelihoodOptions& options) {
  // Who sees the chessboards better than expected was given better numbers, too.
  const double trust = search.noise().tilt_rad / options.camera_error_rad;
  const auto sensitivity = [&](const std::function<Vector6d(const LikelihoodPose&)>& board_shift) {
    const Eigen::Index num_camera_faults = search.state().num_camera_faults;
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(equations.pull.size());
    for (std::size_t i = 0; i < equations.poses.size(); ++i) {
      const LikelihoodPose& pose = search.poses()[i];
      const Vector6d weighted =
          CameraCovariance(pose, search.noise()).inverse() * board_shift(pose);
      const PoseShare& share = equations.poses[i];
      pull -= share.to_board * (share.board_covariance * weighted);
      if (num_camera_faults > 0)
        pull.tail(num_camera_faults) -= pose.camera_faults.board_by_faults.transpose() * weighted;
    }
    return Vector6d((gain * pull).head<kExtrinsicSize>().cwiseAbs2());
  };
  const auto by_lens = [&](const PixelShift& shift_px) {
    return sensitivity(
        [&](const LikelihoodPose& pose) { return BoardShift(pose, camera, shift_px); });
  };
  const Eigen::Vector2d principal_point_px(camera.cx_px, camera.cy_px);
  Vector6d variance = Vector6d::Zero();
  const bool are_intrinsics_unknown = search.state().num_camera_faults == kNumLensErrors;
  if (!are_intrinsics_unknown) {  // else the likelihood counts them
    variance += by_lens([&](const Eigen::Vector2d& pixel_px) -> Eigen::Vector2d {
      return trust * options.focal_length_error * (pixel_px - principal_point_px);
    });
    for (int axis = 0; axis < 2; ++axis) {
      variance += by_lens([&](const Eigen::Vector2d&) -> Eigen::Vector2d {
        return trust * options.principal_point_error_px * Eigen::Vector2d::Unit(axis);
      });
    }
  }
  // A larger board is as much farther away.
  variance += sensitivity([&](const LikelihoodPose& pose) {
    Vector6d shift = Vector6d::Zero();
    shift.tail<3>() = trust * options.board_size_error * pose.T_camera_board.translation();
    return shift;
  });
  return variance.cwiseSqrt();
}

}  // namespace

LikelihoodUncertainty UncertaintyOf(const LikelihoodSearch& search,
                                    const SharedEquations& equations,
                                    const CameraModel& camera,
                                    const LikelihoodOptions& options) {
  const Eigen::MatrixXd gain = search.Gain(equations.information);
  const Matrix6d of_extrinsic = search.Covariance(equations).topLeftCorner<6, 6>();
  LikelihoodUncertainty uncertainty;
  const double few = std::sqrt(FewPosesFactor(static_cast<double>(search.poses().size())));
  uncertainty.by_likelihood = of_extrinsic.diagonal().cwiseSqrt();
  uncertainty.by_resampling = few * Resampled(search, equations, gain);
  uncertainty.by_model_errors = ModelErrors(search, equations, gain, camera, options);
  const Vector6d widened = (few * uncertainty.by_likelihood)
                               .cwiseMax(uncertainty.by_resampling)
                               .cwiseMax(uncertainty.by_model_errors)
                               .cwiseQuotient(uncertainty.by_likelihood);
  uncertainty.covariance = widened.asDiagonal() * of_extrinsic * widened.asDiagonal();
  return uncertainty;
}

}  // namespace voqcal
