#include "core/board/outline_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/board/lidar_beams.hpp"

namespace voqcal {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Vector5d = Eigen::Matrix<double, 5, 1>;

/// EvaluateOutline with the gradient that Refine climbs.
struct Climb {
  OutlineFit fit;
  Vector5d gradient = Vector5d::Zero();
};

/// What is expected of a parameter: a Gaussian about it.
void Expect(double value, double mean, double sigma, Eigen::Index row, Climb* climb) {
  const double surprise = (value - mean) / sigma;
  climb->fit.log_likelihood -= surprise * surprise / 2;
  climb->gradient[row] -= surprise / sigma;
  climb->fit.information(row, row) += 1 / (sigma * sigma);
}

/// L(t) of the model; beyond kFlat it differs from a step by 1e-6: no slope left.
constexpr double kFlat = 14.0;

/// L at two opposite sides: their arguments always add to the same, so one exponential does both.
struct OppositeSides {
  double sum;  // of the two arguments
  double exp_minus_sum;

  explicit OppositeSides(double sum_of_both) : sum(sum_of_both), exp_minus_sum(std::exp(-sum)) {}

  void Logistic(double t, double* L, double* L_opposite) const {
    const bool is_nearer = t <= sum - t;
    const double nearer = is_nearer ? t : sum - t;
    *L = *L_opposite = 1.0;
    if (nearer > kFlat) return;
    const double e = std::exp(-nearer);
    (is_nearer ? *L : *L_opposite) = 1.0 / (1.0 + e);
    (is_nearer ? *L_opposite : *L) = e / (e + exp_minus_sum);
  }
};

/// Sums over beams. A logarithm is taken of many probabilities' product at once.
struct BeamSums {
  double log_likelihood = 0.0;
  double likelihood = 1.0;
  std::array<double, 5> gradient{};
  std::array<double, 15> information{};  // lower triangle, row by row

  void Add(double p_hit, bool is_hit, const std::array<double, 5>& J) {
    constexpr double kTiny = 1e-200;
    likelihood *= is_hit ? p_hit : 1.0 - p_hit;
    if (likelihood < kTiny) Flush();
    const double weight = 1.0 / (p_hit * (1.0 - p_hit));
    const double pull = is_hit ? weight * (1.0 - p_hit) : -weight * p_hit;
    std::size_t k = 0;
    for (std::size_t row = 0; row < 5; ++row) {
      gradient[row] += pull * J[row];
      for (std::size_t col = 0; col <= row; ++col) information[k++] += weight * J[row] * J[col];
    }
  }

  void Flush() {
    log_likelihood += std::log(likelihood);
    likelihood = 1.0;
  }

  void AddTo(Climb* climb) {
    Flush();
    climb->fit.log_likelihood += log_likelihood;
    std::size_t k = 0;
    for (Eigen::Index row = 0; row < 5; ++row) {
      climb->gradient[row] += gradient[static_cast<std::size_t>(row)];
      for (Eigen::Index col = 0; col <= row; ++col, ++k) {
        climb->fit.information(row, col) += information[k];
        if (col != row) climb->fit.information(col, row) += information[k];
      }
    }
  }
};

Climb Differentiate(const std::vector<OutlineBeam>& beams,
                    const OutlineModel& model,
                    const OutlineFit& at) {
  const double keep = 1.0 - model.outlier_share;
  const double log_far = std::log(model.outlier_share / 2);
  const double log_sure = std::log(1.0 - model.outlier_share / 2);
  const Eigen::Vector2d stretch = model.Stretch();
  const Eigen::Vector2d per_blur = (model.blur_m * stretch).cwiseInverse();
  // Sides: right, left, top, bottom. Distance inside, blur, and what thickness adds.
  const Eigen::Vector4d side_lean = model.SideLean();
  const Eigen::Vector4d half_m =
      Eigen::Vector4d(model.width_m, model.width_m, model.height_m, model.height_m) / 2 +
      at.spill_m * Eigen::Vector4d(stretch.x(), stretch.x(), stretch.y(), stretch.y()) +
      at.thickness_m * side_lean;
  const double cosine = std::cos(at.pose.angle_rad);
  const double sine = std::sin(at.pose.angle_rad);
  Climb climb;
  climb.fit.num_beams = beams.size();
  climb.fit.pose = at.pose;
  climb.fit.spill_m = at.spill_m;
  climb.fit.thickness_m = at.thickness_m;
  Expect(at.spill_m, model.spill_m, model.spill_sigma_m, 3, &climb);
  Expect(at.thickness_m, model.thickness_m, model.thickness_sigma_m, 4, &climb);
  const OppositeSides across((half_m[0] + half_m[1]) * per_blur.x());
  const OppositeSides upright((half_m[2] + half_m[3]) * per_blur.y());
  BeamSums sums;
  for (const OutlineBeam& beam : beams) {
    const double dx = beam.position_m.x() - at.pose.centre_m.x();
    const double dy = beam.position_m.y() - at.pose.centre_m.y();
    const double x = cosine * dx + sine * dy;
    const double y = cosine * dy - sine * dx;
    const double right = (half_m[0] - x) * per_blur.x();
    const double left = (half_m[1] + x) * per_blur.x();
    const double top = (half_m[2] - y) * per_blur.y();
    const double bottom = (half_m[3] + y) * per_blur.y();
    const double least = std::min(std::min(right, left), std::min(top, bottom));
    if (std::abs(least) > kFlat) {
      sums.log_likelihood += (least > 0) == beam.is_hit ? log_sure : log_far;
      continue;
    }
    double L_right, L_left, L_top, L_bottom;
    across.Logistic(right, &L_right, &L_left);
    upright.Logistic(top, &L_top, &L_bottom);
    const double kept = keep * L_right * L_left * L_top * L_bottom;
    // d p / d (distance inside each side), then: the centre and the angle move q by -(1, 0), -(0,
    // 1) and (y, -x).
    const double d_right = kept * (1.0 - L_right) * per_blur.x();
    const double d_left = kept * (1.0 - L_left) * per_blur.x();
    const double d_top = kept * (1.0 - L_top) * per_blur.y();
    const double d_bottom = kept * (1.0 - L_bottom) * per_blur.y();
    const double d_x = d_left - d_right;
    const double d_y = d_bottom - d_top;
    const double d_spill = (d_right + d_left) * stretch.x() + (d_top + d_bottom) * stretch.y();
    const double d_thickness = d_right * side_lean[0] + d_left * side_lean[1] +
                               d_top * side_lean[2] + d_bottom * side_lean[3];
    sums.Add(model.outlier_share / 2 + kept,
             beam.is_hit,
             {-d_x, -d_y, d_x * y - d_y * x, d_spill, d_thickness});
  }
  sums.AddTo(&climb);
  return climb;
}

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
  Climb best = Differentiate(beams, model, start);
  for (int i = 0; i < max_iterations; ++i) {
    Matrix5d H = best.fit.information;
    H.diagonal() += damping * H.diagonal() + Vector5d::Constant(1e-6);
    const Vector5d step = H.ldlt().solve(best.gradient);
    if (!step.allFinite()) break;
    const Climb next = Differentiate(beams, model, Moved(best.fit, step));
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

/// Angles over half a turn, the most promising first.
std::vector<double> RankedAngles(const std::vector<OutlineBeam>& beams,
                                 const OutlineModel& model,
                                 const Eigen::Vector2d& centre_m) {
  constexpr int kNumAngles = 12;  // 15 degrees apart: within reach of the wide blur
  std::vector<std::pair<double, double>> ranked;
  for (int i = 0; i < kNumAngles; ++i) {
    const double angle_rad = kPi * i / kNumAngles;
    const double score_m = RoughScore(beams, model, {centre_m, angle_rad}, model.blur_m);
    ranked.emplace_back(-score_m, angle_rad);
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

Eigen::Isometry2d RectanglePose::T_rectangle_plane() const {
  Eigen::Isometry2d T_plane_rectangle = Eigen::Isometry2d::Identity();
  T_plane_rectangle.linear() = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  T_plane_rectangle.translation() = centre_m;
  return T_plane_rectangle.inverse();
}

double SearchBlurM(const OutlineModel& model) {
  return std::min(model.width_m, model.height_m) / 12;
}

Eigen::Matrix3d OutlineFit::PoseCovariance() const {
  return information.inverse().topLeftCorner<3, 3>();
}

OutlineFit EvaluateOutline(const std::vector<OutlineBeam>& beams,
                           const OutlineModel& model,
                           const OutlineFit& at) {
  return Differentiate(beams, model, at).fit;
}

OutlineFit SearchOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const Eigen::Vector2d& centre_m) {
  constexpr std::size_t kNumTried = 3;  // the centre is only about right, so the score may err
  constexpr int kNumFirstSteps = 2;
  constexpr int kNumSteps = 8;
  constexpr std::size_t kNumBeams = 250;
  const std::vector<OutlineBeam> few = Thinned(beams, kNumBeams);
  const OutlineModel wide = WithBlur(model, std::max(model.blur_m, SearchBlurM(model)));
  const std::vector<double> angles_rad = RankedAngles(few, wide, centre_m);
  OutlineFit best;
  for (std::size_t i = 0; i < kNumTried; ++i) {
    const OutlineFit fit =
        Refine(few, wide, StartAt(model, {centre_m, angles_rad[i]}), kNumFirstSteps);
    if (i == 0 || fit.log_likelihood > best.log_likelihood) best = fit;
  }
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
