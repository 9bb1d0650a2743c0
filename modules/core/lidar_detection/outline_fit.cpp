#include "core/lidar_detection/outline_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/lidar_detection/lidar_beams.hpp"

namespace voqcal {
namespace {

OutlineFit Moved(const OutlineFit& from, const Vector5d& step) {
  OutlineFit to = from;
  to.pose.centre_m += Eigen::Rotation2Dd(from.pose.angle_rad) * step.head<2>();
  to.pose.angle_rad += step[2];
  to.spill_m += step[3];
  to.thickness_m += step[4];
  return to;
}

OutlineFit Refine(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const OutlineFit& start,
                  int max_iterations) {
  constexpr double kSmallStep = 1e-5;  // metres and radians: a hundredth of what matters
  constexpr double kMaxDamping = 1e3;
  double damping = 1e-3;
  OutlineSlope best = DifferentiateOutline(beams, model, start);
  for (int i = 0; i < max_iterations; ++i) {
    Matrix5d H = best.fit.information;
    H.diagonal() += damping * H.diagonal() + Vector5d::Constant(1e-6);
    const Vector5d step = H.ldlt().solve(best.gradient);
    if (!step.allFinite()) break;
    const OutlineSlope next = DifferentiateOutline(beams, model, Moved(best.fit, step));
    if (next.fit.log_likelihood > best.fit.log_likelihood) {
      best = next;
      damping = std::max(damping / 10, 1e-6);
    } else {
      damping *= 10;
    }
    if (step.norm() < kSmallStep || damping > kMaxDamping) break;
  }
  return best.fit;
}

/// As expected before any beam was looked at.
OutlineFit StartAt(const OutlineModel& model, const RectanglePose& pose) {
  OutlineFit start;
  start.pose = pose;
  start.spill_m = model.spill_m;
  start.thickness_m = model.thickness_m;
  return start;
}

/// The beams that are near the sides of the rectangle: the others do not move it.
std::vector<OutlineBeam> BeamsNearSides(const std::vector<OutlineBeam>& beams,
                                        const OutlineModel& model,
                                        const RectanglePose& pose) {
  const double reach_m = std::min(model.width_m, model.height_m) / 5;
  const Eigen::Array2d half_m(model.width_m / 2, model.height_m / 2);
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  std::vector<OutlineBeam> near;
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    const double outside_m = (q_m.array().abs() - half_m).maxCoeff();
    if (std::abs(outside_m) < reach_m) near.push_back(beam);
  }
  return near;
}

/// About `max_num` of them, evenly taken whatever the beams' order.
std::vector<OutlineBeam> Thinned(const std::vector<OutlineBeam>& beams, std::size_t max_num) {
  if (beams.size() <= max_num) return beams;
  std::vector<OutlineBeam> thinned;
  thinned.reserve(max_num + max_num / 8);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (IsInShare(i, max_num, beams.size())) thinned.push_back(beams[i]);
  }
  return thinned;
}

/// How well a rectangle divides hits from misses, without exponentials: beams count as far as they
/// are on their own side, up to `blur_m`.
double RoughScore(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const RectanglePose& pose,
                  double blur_m) {
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  const Eigen::Array2d half_m(model.width_m / 2, model.height_m / 2);
  double score_m = 0.0;
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    const double inside_m = (half_m - q_m.array().abs()).minCoeff();
    score_m += std::clamp(beam.is_hit ? inside_m : -inside_m, -blur_m, blur_m);
  }
  return score_m;
}

/// Angles over half a turn, none worse than those beside it, the most promising first: from an
/// angle beside a better one the fit would end at the same rectangle.
std::vector<double> PromisingAngles(const std::vector<OutlineBeam>& beams,
                                    const OutlineModel& model,
                                    const Eigen::Vector2d& centre_m) {
  constexpr std::size_t kNumAngles = 12;  // 15 degrees apart: within reach of the wide blur
  std::array<double, kNumAngles> scores_m{};
  const auto angle_at = [](std::size_t i) { return M_PI * static_cast<double>(i) / kNumAngles; };
  for (std::size_t i = 0; i < kNumAngles; ++i) {
    scores_m[i] = RoughScore(beams, model, {centre_m, angle_at(i)}, model.blur_m);
  }
  std::vector<std::pair<double, double>> ranked;
  for (std::size_t i = 0; i < kNumAngles; ++i) {
    const double beside_m =
        std::max(scores_m[(i + 1) % kNumAngles], scores_m[(i + kNumAngles - 1) % kNumAngles]);
    if (scores_m[i] >= beside_m) ranked.emplace_back(-scores_m[i], angle_at(i));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<double> angles_rad;
  for (const auto& [score_m, angle_rad] : ranked) angles_rad.push_back(angle_rad);
  return angles_rad;
}

OutlineModel WithBlur(OutlineModel model, double blur_m) {
  model.blur_m = blur_m;
  return model;
}

}  // namespace

double SearchBlurM(const OutlineModel& model) {
  return std::min(model.width_m, model.height_m) / 12;
}

OutlineFit SearchOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const Eigen::Vector2d& centre_m) {
  constexpr std::size_t kNumTried = 3;  // the centre is only about right, so the score may err
  constexpr int kNumFirstSteps = 2;
  constexpr int kNumSteps = 4;
  constexpr double kHopeless = 0.6;  // nats of a beam; boards have 0.4 by then, as a rule 0.1
  constexpr std::size_t kNumBeams = 250;
  const std::vector<OutlineBeam> few = Thinned(beams, kNumBeams);
  const OutlineModel wide = WithBlur(model, std::max(model.blur_m, SearchBlurM(model)));
  const std::vector<double> angles_rad = PromisingAngles(few, wide, centre_m);
  OutlineFit best;
  for (std::size_t i = 0; i < std::min(kNumTried, angles_rad.size()); ++i) {
    const OutlineFit fit =
        Refine(few, wide, StartAt(model, {centre_m, angles_rad[i]}), kNumFirstSteps);
    if (i == 0 || fit.log_likelihood > best.log_likelihood) best = fit;
  }
  if (best.Unexplained() > kHopeless) return best;
  return Refine(few, wide, best, kNumSteps);
}

OutlineFit SharpenOutline(const std::vector<OutlineBeam>& beams,
                          const OutlineModel& model,
                          const RectanglePose& start,
                          double first_blur_m) {
  constexpr int kNumSteps = 4;
  constexpr double kShrink = 3.0;
  constexpr std::size_t kNumBeams = 500;
  const std::vector<OutlineBeam> few = Thinned(BeamsNearSides(beams, model, start), kNumBeams);
  OutlineFit fit = StartAt(model, start);
  for (double blur_m = first_blur_m; blur_m > model.blur_m; blur_m /= kShrink) {
    fit = Refine(few, WithBlur(model, blur_m), fit, kNumSteps);
  }
  return fit;
}

OutlineFit RefineOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const RectanglePose& start) {
  constexpr int kMaxIterations = 15;
  const OutlineFit rough = SharpenOutline(beams, model, start, 2 * model.blur_m);
  const std::vector<OutlineBeam> near = BeamsNearSides(beams, model, start);
  return EvaluateOutline(beams, model, Refine(near, model, rough, kMaxIterations));
}

}  // namespace voqcal
