#include "core/lidar_detection/outline_doubt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/board/half_turn.hpp"
#include "core/lidar_detection/lidar_beams.hpp"

namespace voqcal {
namespace {

constexpr double kExpectedM = 0.25;  // of the centre and, by a turn, of the corners: 1 sigma

/// Metres for each unit of [x; y; angle]: a turn moves the corners by half the diagonal.
Eigen::Vector3d MetresPerUnit(const OutlineModel& model) {
  return {1.0, 1.0, std::hypot(model.width_m, model.height_m) / 2};
}

/// Of [x; y; angle], all in metres.
Eigen::Matrix3d CovarianceM2(const OutlineFit& fit, const OutlineModel& model) {
  const Eigen::Vector3d metres = MetresPerUnit(model);
  Matrix5d information = fit.information;
  information.topLeftCorner<3, 3>() +=
      Eigen::Matrix3d((metres / kExpectedM).cwiseAbs2().asDiagonal());
  const Eigen::Matrix3d covariance = information.inverse().topLeftCorner<3, 3>();
  return metres.asDiagonal() * covariance * metres.asDiagonal();
}

OutlineFit MovedBy(const OutlineFit& fit,
                   const Eigen::Vector3d& step_m,
                   const OutlineModel& model) {
  const Eigen::Vector3d step = step_m.cwiseQuotient(MetresPerUnit(model));
  OutlineFit moved = fit;
  moved.pose.centre_m += Eigen::Rotation2Dd(fit.pose.angle_rad) * step.head<2>();
  moved.pose.angle_rad += step.z();
  return moved;
}

/// Mean and variance of where the rectangle lies along a line through `fit`, by the likelihood.
struct Moments {
  double mean_m = 0.0;
  double variance_m2 = 0.0;
};

Moments PosteriorAlong(const std::vector<OutlineBeam>& beams,
                       const OutlineModel& model,
                       const OutlineFit& fit,
                       const Eigen::Vector3d& direction,
                       double sigma_m) {
  constexpr int kHalfSteps = 20;
  constexpr double kSigmas = 3.0;
  constexpr double kFarthestM = 0.3;  // as far as misses beside an edge count
  const double step_m = std::min(kSigmas * sigma_m, kFarthestM) / kHalfSteps;
  std::array<double, 2 * kHalfSteps + 1> log_likelihood{};
  for (int i = -kHalfSteps; i <= kHalfSteps; ++i) {
    log_likelihood[static_cast<std::size_t>(i + kHalfSteps)] =
        OutlineLogLikelihood(beams, model, MovedBy(fit, i * step_m * direction, model));
  }
  const double largest = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  double sum = 0.0;
  Moments moments;
  for (int i = -kHalfSteps; i <= kHalfSteps; ++i) {
    const double weight =
        std::exp(log_likelihood[static_cast<std::size_t>(i + kHalfSteps)] - largest);
    sum += weight;
    moments.mean_m += weight * i * step_m;
    moments.variance_m2 += weight * i * step_m * i * step_m;
  }
  moments.mean_m /= sum;
  // Within a step the likelihood was not looked at.
  moments.variance_m2 =
      moments.variance_m2 / sum - moments.mean_m * moments.mean_m + step_m * step_m / 12;
  return moments;
}

}  // namespace

double CornerSigmaM(const OutlineFit& fit, const OutlineModel& model) {
  const Eigen::Matrix3d covariance = CovarianceM2(fit, model);
  const double half_diagonal_m = MetresPerUnit(model).z();
  double largest_m2 = 0.0;
  for (const double side : {-1.0, 1.0}) {  // opposite corners are equally certain
    Eigen::Matrix<double, 2, 3> J;
    J << 1, 0, -model.height_m / 2 / half_diagonal_m,  //
        0, 1, side * model.width_m / 2 / half_diagonal_m;
    const Eigen::Matrix2d corner_m2 = J * covariance * J.transpose();
    largest_m2 = std::max(largest_m2, corner_m2.selfadjointView<Eigen::Lower>().eigenvalues().y());
  }
  return std::sqrt(largest_m2);
}

OutlineFit SettleOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         OutlineFit fit) {
  constexpr double kSharpM = 0.01;  // below, lines are so dense that the curvature is right
  // All directions at the start: each is settled across those before it.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(CovarianceM2(fit, model));
  const Eigen::Vector3d metres = MetresPerUnit(model);
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  for (const Eigen::Index i : {2, 1, 0}) {  // the loosest first
    const double sigma_m = std::sqrt(axes.eigenvalues()[i]);
    if (sigma_m < kSharpM) break;
    const Eigen::Vector3d direction = axes.eigenvectors().col(i);
    const Moments posterior = PosteriorAlong(beams, model, fit, direction, sigma_m);
    fit = EvaluateOutline(beams, model, MovedBy(fit, posterior.mean_m * direction, model));
    fit.information.topLeftCorner<3, 3>() += added;
    // Adding k h h' to the information turns the variance v along h into 1 / (1 / v + k)
    // (Sherman and Morrison 1950).
    const double variance_m2 = direction.dot(CovarianceM2(fit, model) * direction);
    const Eigen::Vector3d h = direction.cwiseProduct(metres);
    const double k = 1 / posterior.variance_m2 - 1 / variance_m2;
    added += k * h * h.transpose();
    fit.information.topLeftCorner<3, 3>() += k * h * h.transpose();
  }
  return fit;
}

bool HasTurnedRival(const std::vector<OutlineBeam>& beams,
                    const OutlineModel& model,
                    const OutlineFit& best) {
  constexpr int kNumAngles = 18;  // 10 degrees apart
  constexpr double kFiveDegreesRad = 0.0873;
  const double same_after_rad = IsSquare(model.width_m, model.height_m) ? M_PI / 2 : M_PI;
  constexpr double kAsGood = 5.0;  // ln 150
  for (int i = 1; i < kNumAngles; ++i) {
    const RectanglePose turned{best.pose.centre_m, best.pose.angle_rad + M_PI * i / kNumAngles};
    const OutlineFit rough = SharpenOutline(beams, model, turned, SearchBlurM(model) / 2);
    const OutlineFit rival = RefineOutline(beams, model, rough.pose);
    const double turn_rad =
        std::remainder(rival.pose.angle_rad - best.pose.angle_rad, same_after_rad);
    const bool is_turned = std::abs(turn_rad) > kFiveDegreesRad;
    if (is_turned && rival.log_likelihood > best.log_likelihood - kAsGood) return true;
  }
  return false;
}

bool HasRivalSize(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const OutlineFit& best,
                  const Eigen::Vector2d& grows) {
  constexpr std::array<double, 3> kOffM = {0.0, 0.06, 0.12};
  constexpr double kBetter = 4.0;          // ln 50
  constexpr double kWithinReach = 20.0;    // refining a rival gains less: 3 as a rule
  constexpr std::size_t kNumBeams = 1000;  // tell another size as well as more do
  std::vector<OutlineBeam> few;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (IsInShare(i, kNumBeams, beams.size())) few.push_back(beams[i]);
  }
  const double to_beat = OutlineLogLikelihood(few, model, best) + kBetter;
  for (const double off_x_m : kOffM) {
    for (const double off_y_m : kOffM) {
      if (off_x_m == 0.0 && off_y_m == 0.0) continue;
      const Eigen::Vector2d off_m = grows.cwiseProduct(Eigen::Vector2d(off_x_m, off_y_m));
      OutlineModel other = model;
      other.width_m += off_m.x();
      other.height_m += off_m.y();
      const OutlineFit rough = SharpenOutline(few, other, best.pose, SearchBlurM(model) / 2);
      if (OutlineLogLikelihood(few, other, rough) < to_beat - kWithinReach) continue;
      if (RefineOutline(few, other, rough.pose).log_likelihood > to_beat) return true;
    }
  }
  return false;
}

}  // namespace voqcal
