#include "core/estimation/variance_components.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/estimation/is_regular.hpp"
#include "core/estimation/pose_difference.hpp"

namespace voqcal {
namespace {

using SharedVector = Eigen::Matrix<double, kNumSharedErrors, 1>;

SharedVector ToVector(const SharedErrors& shared) {
  SharedVector vector;
  vector << shared.range_offset_m, shared.outline_lift_m, shared.outline_rise,
      shared.chessboard_turn_x_rad, shared.chessboard_turn_y_rad;
  return vector;
}

SharedErrors FromVector(const SharedVector& vector) {
  return {vector[0], vector[1], vector[2], vector[3], vector[4]};
}

void Move(const MixedVector& step, MixedFit* fit) {
  fit->T_camera_lidar = PerturbLeft(fit->T_camera_lidar, step.head<6>());
  fit->shared = FromVector(ToVector(fit->shared) + step.tail<kNumSharedErrors>());
}

// How the shared errors move the difference: the lidar's centre along its ray, and across it
// upwards; the chessboard's rotation.
Eigen::Matrix<double, 6, kNumSharedErrors> BySharedErrors(const Eigen::Vector3d& centre_lidar_m,
                                                          const Eigen::Matrix3d& R_camera_lidar) {
  const Eigen::Vector3d ray = centre_lidar_m.normalized();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - ray.z() * ray;
  Eigen::Matrix<double, 6, kNumSharedErrors> J = Eigen::Matrix<double, 6, kNumSharedErrors>::Zero();
  J.topRightCorner<2, 2>() = -Eigen::Matrix2d::Identity();
  J.bottomLeftCorner<3, 3>() << R_camera_lidar * ray, R_camera_lidar * up,
      centre_lidar_m.norm() * (R_camera_lidar * up);
  return J;
}

// Gauss-Newton's equations about a fit, its priors included.
struct MixedEquations {
  MixedMatrix information;
  MixedVector pull = MixedVector::Zero();

  explicit MixedEquations(const MixedFit& fit)
      : information(MixedPriorInformation(fit.shared_prior)) {
    pull.tail<kNumSharedErrors>() =
        -information.bottomRightCorner<kNumSharedErrors, kNumSharedErrors>() * ToVector(fit.shared);
  }

  void Add(const MixedDifference& d, const Matrix6d& weight) {
    information += d.J.transpose() * weight * d.J;
    pull -= d.J.transpose() * (weight * d.r);
  }
};

// To the minimum for these errors; each pose with its robust weight.
void Minimise(const std::vector<const BoardSample*>& samples,
              const CameraModel& camera,
              MixedFit* fit) {
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-9;     // radians and metres
  constexpr double kCauchyWidth = 2.385;  // 95 % efficient on normal noise
  constexpr double kDimensions = 6.0;
  fit->is_usable = false;
  for (int i = 0; i < kMaxIterations && !fit->is_usable; ++i) {
    MixedEquations equations(*fit);
    for (const BoardSample* sample : samples) {
      const MixedDifference d = DifferenceOf(*sample, camera, *fit);
      const Matrix6d W = d.C.llt().solve(Matrix6d::Identity());
      const double squared = d.r.dot(W * d.r);
      equations.Add(d, W / (1.0 + squared / (kDimensions * kCauchyWidth * kCauchyWidth)));
    }
    if (!IsRegular(equations.information)) return;
    const Eigen::LLT<MixedMatrix> cholesky(equations.information);
    const MixedVector step = cholesky.solve(equations.pull);
    if (!step.allFinite()) return;
    Move(step, fit);
    fit->covariance = cholesky.solve(MixedMatrix::Identity());
    fit->is_usable = step.norm() < kConverged;
  }
}

// One board's difference without any error of its own, and how each error widens it.
struct Sighting {
  MixedDifference difference;
  std::array<Matrix6d, kNumSightingErrors> units;

  Matrix6d Weight(const SightingVariances& variances) const {
    Matrix6d V = difference.C;
    for (std::size_t k = 0; k < units.size(); ++k) V += variances[k] * units[k];
    return V.llt().solve(Matrix6d::Identity());
  }
};

std::vector<Sighting> SightingsAt(const std::vector<const BoardSample*>& samples,
                                  const CameraModel& camera,
                                  MixedFit fit) {
  fit.errors = {};
  std::vector<Sighting> sightings;
  for (const BoardSample* sample : samples) {
    sightings.push_back({DifferenceOf(*sample, camera, fit),
                         UnitCovariances(sample->camera.pose, fit.T_camera_lidar.linear())});
  }
  return sightings;
}

// One step towards the maximum. With r, V, J of all sightings stacked and
//     P = V^-1 - V^-1 J (J' V^-1 J)^-1 J' V^-1
// a variance v whose unit is U goes to
//     sqrt((v^2 r'P U P r + w s^2) / (tr(P U) + w / v)),   s^2: its prior's, which weighs w
SightingVariances Step(const std::vector<Sighting>& sightings,
                       const MixedFit& fit,
                       const SightingVariances& v,
                       const SightingVariances& prior) {
  std::vector<Matrix6d> weights;
  MixedEquations equations(fit);
  for (const Sighting& each : sightings) {
    equations.Add(each.difference, weights.emplace_back(each.Weight(v)));
  }
  const Eigen::LLT<MixedMatrix> cholesky(equations.information);
  const MixedVector delta = cholesky.solve(equations.pull);
  SightingVariances squares{};
  SightingVariances traces{};
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const MixedDifference& d = sightings[i].difference;
    const Vector6d Pr = weights[i] * (d.r + d.J * delta);
    const Eigen::Matrix<double, 6, kMixedSize> WJ = weights[i] * d.J;
    const Matrix6d P = weights[i] - WJ * cholesky.solve(WJ.transpose());
    for (std::size_t k = 0; k < v.size(); ++k) {
      squares[k] += Pr.dot(sightings[i].units[k] * Pr);
      traces[k] += P.cwiseProduct(sightings[i].units[k]).sum();
    }
  }
  SightingVariances next{};
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double w = kPriorWeights[k];
    next[k] = std::sqrt((v[k] * v[k] * squares[k] + w * prior[k]) / (traces[k] + w / v[k]));
  }
  return next;
}

}  // namespace

SharedErrors MixedFit::SharedAt(const Eigen::Isometry3d& T_camera_lidar_given) const {
  // The expectation, of a normal distribution.
  const Eigen::Matrix<double, kNumSharedErrors, 6> by_extrinsic =
      covariance.bottomLeftCorner<kNumSharedErrors, 6>() * ExtrinsicCovariance().inverse();
  return FromVector(ToVector(shared) +
                    by_extrinsic * DifferenceLeft(T_camera_lidar, T_camera_lidar_given));
}

ChessboardTurn MixedFit::ChessboardTurnAt(const Eigen::Isometry3d& T_camera_lidar_given) const {
  const SharedErrors at = SharedAt(T_camera_lidar_given);
  return {{at.chessboard_turn_x_rad, at.chessboard_turn_y_rad},
          covariance.diagonal().tail<2>().cwiseSqrt()};
}

MixedDifference DifferenceOf(const BoardSample& sample,
                             const CameraModel& camera,
                             const MixedFit& fit) {
  const PoseDifference plain = DifferenceOf(sample, camera, fit.T_camera_lidar, {});
  const auto J_shared = BySharedErrors(sample.lidar.pose.centre_m, fit.T_camera_lidar.linear());
  MixedDifference difference;
  difference.r = plain.r + J_shared * ToVector(fit.shared);
  difference.C = plain.C + fit.errors.CovarianceOf(sample.camera.pose, fit.T_camera_lidar.linear());
  difference.J << plain.J, J_shared;
  return difference;
}

MixedMatrix MixedPriorInformation(const SharedErrors& prior) {
  MixedMatrix information = MixedMatrix::Zero();
  information.diagonal().tail<kNumSharedErrors>() = ToVector(prior).cwiseAbs2().cwiseInverse();
  return information;
}

MixedFit FitWithErrors(const std::vector<const BoardSample*>& samples,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar_start,
                       const ErrorPriors& priors) {
  constexpr int kRounds = 2;  // the extrinsic hardly moves by its weights
  constexpr int kSteps = 60;  // to a percent
  const SightingVariances prior = SquaresOf(priors.sighting);
  SightingVariances variances = prior;
  MixedFit fit;
  fit.T_camera_lidar = T_camera_lidar_start;
  fit.shared_prior = priors.shared;
  for (int round = 0; round < kRounds; ++round) {
    fit.errors = RootsOf(variances);
    Minimise(samples, camera, &fit);
    if (!fit.is_usable) return fit;
    const auto sightings = SightingsAt(samples, camera, fit);
    for (int i = 0; i < kSteps; ++i) variances = Step(sightings, fit, variances, prior);
  }
  fit.errors = RootsOf(variances);
  Minimise(samples, camera, &fit);
  return fit;
}

MixedFit FitNearby(const std::vector<const BoardSample*>& samples,
                   const CameraModel& camera,
                   const MixedFit& nearby) {
  MixedFit fit = nearby;
  Minimise(samples, camera, &fit);
  return fit;
}

}  // namespace voqcal
