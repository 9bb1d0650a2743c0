#include "core/estimation/variance_components.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

#include "core/estimation/pose_difference.hpp"

namespace voqcal {
namespace {

using Variances = std::array<double, 4>;  // of SightingErrors, in its order
using Units = std::array<Matrix6d, 4>;

Variances SquaresOf(const SightingErrors& errors) {
  return {errors.along_ray_m * errors.along_ray_m,
          errors.across_ray_m * errors.across_ray_m,
          errors.tilt_rad * errors.tilt_rad,
          errors.turn_rad * errors.turn_rad};
}

SightingErrors RootsOf(const Variances& v) {
  return {std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

// One board's difference between the sensors, and how each error widens it.
struct Sighting {
  PoseDifference difference;
  Units units;

  Matrix6d Weight(const Variances& variances) const {
    Matrix6d V = difference.C;
    for (std::size_t k = 0; k < units.size(); ++k) V += variances[k] * units[k];
    return V.llt().solve(Matrix6d::Identity());
  }
};

std::vector<Sighting> SightingsAt(const std::vector<const BoardSample*>& samples,
                                  const CameraModel& camera,
                                  const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<Sighting> sightings;
  for (const BoardSample* sample : samples) {
    sightings.push_back(
        {DifferenceOf(*sample, camera, T_camera_lidar, {}), UnitCovariances(sample->camera.pose)});
  }
  return sightings;
}

// One step towards the maximum. With r, V, J of all sightings stacked and
//     P = V^-1 - V^-1 J (J' V^-1 J)^-1 J' V^-1
// a variance v whose unit is U goes to
//     sqrt((v^2 r'P U P r + s^2) / (tr(P U) + 1 / v)),   s^2: its prior's
Variances Step(const std::vector<Sighting>& sightings, const Variances& v, const Variances& prior) {
  std::vector<Matrix6d> weights;
  Matrix6d information = Matrix6d::Zero();
  Vector6d pull = Vector6d::Zero();
  for (const Sighting& each : sightings) {
    const Matrix6d& W = weights.emplace_back(each.Weight(v));
    information += each.difference.J.transpose() * W * each.difference.J;
    pull -= each.difference.J.transpose() * W * each.difference.r;
  }
  const Eigen::LLT<Matrix6d> cholesky(information);
  const Vector6d delta = cholesky.solve(pull);
  Variances squares{};
  Variances traces{};
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const PoseDifference& d = sightings[i].difference;
    const Vector6d Pr = weights[i] * (d.r + d.J * delta);
    const Matrix6d WJ = weights[i] * d.J;
    const Matrix6d P = weights[i] - WJ * cholesky.solve(WJ.transpose());
    for (std::size_t k = 0; k < v.size(); ++k) {
      squares[k] += Pr.dot(sightings[i].units[k] * Pr);
      traces[k] += P.cwiseProduct(sightings[i].units[k]).sum();
    }
  }
  Variances next{};
  for (std::size_t k = 0; k < v.size(); ++k) {
    next[k] = std::sqrt((v[k] * v[k] * squares[k] + prior[k]) / (traces[k] + 1.0 / v[k]));
  }
  return next;
}

}  // namespace

MixedFit FitWithErrors(const std::vector<const BoardSample*>& samples,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar_start) {
  constexpr int kRounds = 2;  // the extrinsic hardly moves by its weights
  constexpr int kSteps = 60;  // to a percent
  const Variances prior = SquaresOf(kPriorErrors);
  Variances variances = prior;
  MixedFit mixed;
  mixed.fit.T_camera_lidar = T_camera_lidar_start;
  for (int round = 0; round < kRounds; ++round) {
    mixed.errors = RootsOf(variances);
    mixed.fit = FitPoses(samples, camera, mixed.fit.T_camera_lidar, {}, mixed.errors);
    if (!mixed.fit.is_usable) return mixed;
    const auto sightings = SightingsAt(samples, camera, mixed.fit.T_camera_lidar);
    for (int step = 0; step < kSteps; ++step) variances = Step(sightings, variances, prior);
  }
  mixed.errors = RootsOf(variances);
  mixed.fit = FitPoses(samples, camera, mixed.fit.T_camera_lidar, {}, mixed.errors);
  return mixed;
}

}  // namespace voqcal
