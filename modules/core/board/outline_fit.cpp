#include "core/board/outline_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace voqcal {
namespace {

constexpr double kPi = 3.14159265358979323846;

double Logistic(double t) { return 1.0 / (1.0 + std::exp(-t)); }

/// EvaluateOutline with the gradient that RefineOutline climbs.
struct Climb {
  OutlineFit fit;
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
};

Climb Differentiate(const std::vector<OutlineBeam>& beams,
                    const OutlineModel& model,
                    const RectanglePose& pose,
                    double spill_m) {
  constexpr double kFlat = 14.0;  // L(14) differs from 1 by 1e-6: no slope left
  const double keep = 1.0 - model.outlier_share;
  const double half_x_m = model.width_m / 2 + spill_m;
  const double half_y_m = model.height_m / 2 + spill_m;
  const Eigen::Rotation2Dd R_rectangle_plane(-pose.angle_rad);
  Climb climb;
  climb.fit.pose = pose;
  climb.fit.spill_m = spill_m;
  const double surprise = (spill_m - model.spill_m) / model.spill_sigma_m;
  climb.fit.log_likelihood = -surprise * surprise / 2;
  climb.gradient[3] = -surprise / model.spill_sigma_m;
  climb.fit.information(3, 3) = 1 / (model.spill_sigma_m * model.spill_sigma_m);
  const double log_far = std::log(model.outlier_share / 2);
  const double log_sure = std::log(1.0 - model.outlier_share / 2);
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = R_rectangle_plane * (beam.position_m - pose.centre_m);
    const double inside_x = (half_x_m - std::abs(q_m.x())) / model.blur_m;
    const double inside_y = (half_y_m - std::abs(q_m.y())) / model.blur_m;
    const double inside = std::min(inside_x, inside_y);
    if (std::abs(inside) > kFlat) {
      climb.fit.log_likelihood += (inside > 0) == beam.is_hit ? log_sure : log_far;
      continue;
    }
    const double right = Logistic((half_x_m - q_m.x()) / model.blur_m);
    const double left = Logistic((half_x_m + q_m.x()) / model.blur_m);
    const double top = Logistic((half_y_m - q_m.y()) / model.blur_m);
    const double bottom = Logistic((half_y_m + q_m.y()) / model.blur_m);
    const double product = right * left * top * bottom;
    const double p_hit = model.outlier_share / 2 + keep * product;
    // d product / d q, then q changes by -[1 0; 0 1] with the centre and by (y, -x) with the angle.
    const double slope_x = product * (right - left) / model.blur_m;
    const double slope_y = product * (top - bottom) / model.blur_m;
    const double slope_spill = product * (4 - right - left - top - bottom) / model.blur_m;
    const Eigen::Vector4d J =
        keep *
        Eigen::Vector4d(-slope_x, -slope_y, slope_x * q_m.y() - slope_y * q_m.x(), slope_spill);
    climb.fit.log_likelihood += std::log(beam.is_hit ? p_hit : 1.0 - p_hit);
    climb.gradient += J / (beam.is_hit ? p_hit : p_hit - 1.0);
    climb.fit.information += J * J.transpose() / (p_hit * (1.0 - p_hit));
  }
  return climb;
}

RectanglePose Moved(const RectanglePose& pose, const Eigen::Vector4d& step) {
  const Eigen::Rotation2Dd R_plane_rectangle(pose.angle_rad);
  return {pose.centre_m + R_plane_rectangle * step.head<2>(), pose.angle_rad + step[2]};
}

OutlineFit Refine(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const RectanglePose& start,
                  double start_spill_m,
                  int max_iterations) {
  constexpr double kSmallStep = 1e-6;  // metres and radians: a thousandth of what matters
  double damping = 1e-3;
  Climb best = Differentiate(beams, model, start, start_spill_m);
  for (int i = 0; i < max_iterations; ++i) {
    Eigen::Matrix4d H = best.fit.information;
    H.diagonal() += damping * H.diagonal() + Eigen::Vector4d::Constant(1e-6);
    const Eigen::Vector4d step = H.ldlt().solve(best.gradient);
    if (!step.allFinite()) break;
    const Climb next =
        Differentiate(beams, model, Moved(best.fit.pose, step), best.fit.spill_m + step[3]);
    if (next.fit.log_likelihood > best.fit.log_likelihood) {
      best = next;
      damping = std::max(damping / 10, 1e-6);
    } else {
      damping *= 10;
    }
    if (step.norm() < kSmallStep) break;
  }
  return best.fit;
}

/// Every n-th beam, so that about `max_num` are left.
std::vector<OutlineBeam> Thinned(const std::vector<OutlineBeam>& beams, std::size_t max_num) {
  const std::size_t stride = beams.size() / max_num + 1;
  std::vector<OutlineBeam> thinned;
  for (std::size_t i = 0; i < beams.size(); i += stride) thinned.push_back(beams[i]);
  return thinned;
}

}  // namespace

Eigen::Vector2d RectanglePose::ToRectangle(const Eigen::Vector2d& position_m) const {
  return Eigen::Rotation2Dd(-angle_rad) * (position_m - centre_m);
}

Eigen::Matrix3d OutlineFit::PoseCovariance() const {
  return information.inverse().topLeftCorner<3, 3>();
}

OutlineFit EvaluateOutline(const std::vector<OutlineBeam>& beams,
                           const OutlineModel& model,
                           const RectanglePose& pose,
                           double spill_m) {
  return Differentiate(beams, model, pose, spill_m).fit;
}

OutlineFit RefineOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const RectanglePose& start) {
  constexpr int kMaxIterations = 30;
  OutlineModel wide = model;
  wide.blur_m = 2 * model.blur_m;
  const OutlineFit near = Refine(beams, wide, start, model.spill_m, kMaxIterations / 3);
  return Refine(beams, model, near.pose, near.spill_m, kMaxIterations);
}

OutlineFit SearchOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const Eigen::Vector2d& centre_m) {
  constexpr int kNumAngles = 6;  // over half a turn: 30 degrees, within reach of the wide blur
  constexpr int kNumSteps = 5;
  constexpr std::size_t kNumBeams = 250;
  const std::vector<OutlineBeam> few = Thinned(beams, kNumBeams);
  OutlineModel wide = model;
  wide.blur_m = std::max(model.blur_m, std::min(model.width_m, model.height_m) / 12);
  OutlineFit best;
  for (int i = 0; i < kNumAngles; ++i) {
    const OutlineFit fit =
        Refine(few, wide, {centre_m, kPi * i / kNumAngles}, model.spill_m, kNumSteps);
    if (i == 0 || fit.log_likelihood > best.log_likelihood) best = fit;
  }
  wide.blur_m = std::sqrt(wide.blur_m * model.blur_m);
  return Refine(beams, wide, best.pose, model.spill_m, 2 * kNumSteps);
}

}  // namespace voqcal
