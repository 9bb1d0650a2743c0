#include "core/lidar_detection/outline_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace voqcal {
namespace {

/// L(t) of the model; beyond kFlat it differs from a step by 5e-5: no slope left that counts.
constexpr double kFlat = 10.0;

/// L at one side.
struct Share {
  double inside = 1.0;  ///< L...
  double rest = 0.0;    ///< ...and 1 - L; of the nearer side exact where L is nearly 1.
};

/// L at two opposite sides: their arguments always add to the same, so one exponential does both.
class OppositeSides {
 public:
  explicit OppositeSides(double sum_of_both)
      : sum_(sum_of_both), exp_minus_sum_(std::exp(-sum_of_both)) {}

  void At(double t, Share* side, Share* opposite) const {
    const bool is_nearer = t <= sum_ - t;
    const double nearer = is_nearer ? t : sum_ - t;
    if (nearer > kFlat) return;
    const double e = std::exp(-nearer);
    const double L = 1.0 / (1.0 + e);
    const double L_farther = e / (e + exp_minus_sum_);
    *(is_nearer ? side : opposite) = {L, e * L};
    *(is_nearer ? opposite : side) = {L_farther, 1.0 - L_farther};
  }

 private:
  double sum_;  // of the two arguments
  double exp_minus_sum_;
};

/// A beam near a side, in the rectangle's axes.
struct NearBeam {
  double x_m;
  double y_m;
  bool is_hit;
  Share right, left, top, bottom;

  /// prod_k L(...) of the model.
  double Inside() const { return right.inside * left.inside * top.inside * bottom.inside; }
};

/// OutlineModel's rectangle, ready for many beams.
class BlurredRectangle {
 public:
  BlurredRectangle(const OutlineModel& model, const OutlineFit& at)
      : stretch(model.Stretch()),
        per_blur((model.blur_m * stretch).cwiseInverse()),
        side_lean(model.SideLean()),
        half_m_(Eigen::Vector4d(model.width_m, model.width_m, model.height_m, model.height_m) / 2 +
                at.spill_m * Eigen::Vector4d(stretch.x(), stretch.x(), stretch.y(), stretch.y()) +
                at.thickness_m * side_lean),
        centre_m_(at.pose.centre_m),
        cosine_(std::cos(at.pose.angle_rad)),
        sine_(std::sin(at.pose.angle_rad)),
        across_((half_m_[0] + half_m_[1]) * per_blur.x()),
        upright_((half_m_[2] + half_m_[3]) * per_blur.y()),
        log_far_{{{std::log(1.0 - model.stray_hits), std::log(model.stray_hits)},
                  {std::log(model.stray_misses), std::log(1.0 - model.stray_misses)}}} {}

  /// Visits the beams near a side. Returns the log-likelihood of all others.
  template <typename Visit>
  double ForEachNear(const std::vector<OutlineBeam>& beams, Visit visit) const {
    std::array<std::array<std::size_t, 2>, 2> num_far{};
    for (const OutlineBeam& beam : beams) {
      const double dx_m = beam.position_m.x() - centre_m_.x();
      const double dy_m = beam.position_m.y() - centre_m_.y();
      const double x_m = cosine_ * dx_m + sine_ * dy_m;
      const double y_m = cosine_ * dy_m - sine_ * dx_m;
      const double right = (half_m_[0] - x_m) * per_blur.x();
      const double left = (half_m_[1] + x_m) * per_blur.x();
      const double top = (half_m_[2] - y_m) * per_blur.y();
      const double bottom = (half_m_[3] + y_m) * per_blur.y();
      const double least = std::min(std::min(right, left), std::min(top, bottom));
      if (std::abs(least) > kFlat) {
        ++num_far[least > 0][beam.is_hit];
        continue;
      }
      NearBeam near{x_m, y_m, beam.is_hit, {}, {}, {}, {}};
      across_.At(right, &near.right, &near.left);
      upright_.At(top, &near.top, &near.bottom);
      visit(near);
    }
    double log_likelihood = 0.0;
    for (const std::size_t is_inside : {0U, 1U}) {
      for (const std::size_t is_hit : {0U, 1U}) {
        log_likelihood +=
            static_cast<double>(num_far[is_inside][is_hit]) * log_far_[is_inside][is_hit];
      }
    }
    return log_likelihood;
  }

  const Eigen::Vector2d stretch;
  const Eigen::Vector2d per_blur;
  const Eigen::Vector4d side_lean;  ///< Right, left, top, bottom.

 private:
  Eigen::Vector4d half_m_;  // from the centre to each side, in the same order
  Eigen::Vector2d centre_m_;
  double cosine_;
  double sine_;
  OppositeSides across_;
  OppositeSides upright_;
  std::array<std::array<double, 2>, 2> log_far_;  // of a beam: inside or not, a hit or not
};

/// The logarithm of a product of many probabilities, taken of many at once.
class LogProduct {
 public:
  void Add(double probability) {
    constexpr double kTiny = 1e-200;
    product_ *= probability;
    if (product_ > kTiny) return;
    log_ += std::log(product_);
    product_ = 1.0;
  }
  double Value() const { return log_ + std::log(product_); }

 private:
  double log_ = 0.0;
  double product_ = 1.0;
};

double LogGaussian(double surprise) { return -surprise * surprise / 2; }

double SpillSurprise(const OutlineModel& model, const OutlineFit& at) {
  return (at.spill_m - model.spill_m) / model.spill_sigma_m;
}

double ThicknessSurprise(const OutlineModel& model, const OutlineFit& at) {
  return (at.thickness_m - model.thickness_m) / model.thickness_sigma_m;
}

/// [x; y; angle] of the fit from the expected rectangle, along the latter's axes.
Eigen::Vector3d OffExpected(const ExpectedRectangle& expected, const OutlineFit& at) {
  Eigen::Vector3d off;
  off << expected.pose.T_rectangle_plane() * at.pose.centre_m,
      std::remainder(at.pose.angle_rad - expected.pose.angle_rad, 2 * M_PI);
  return off;
}

/// By [x; y; angle] of the fit, x and y along its own axes.
Eigen::Matrix3d JacobianOfOff(const ExpectedRectangle& expected, const OutlineFit& at) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() =
      Eigen::Rotation2Dd(at.pose.angle_rad - expected.pose.angle_rad).toRotationMatrix();
  return J;
}

/// Of all but the beams.
double LogPrior(const OutlineModel& model, const OutlineFit& at) {
  const double log_prior =
      LogGaussian(SpillSurprise(model, at)) + LogGaussian(ThicknessSurprise(model, at));
  if (!model.expected) return log_prior;
  const Eigen::Vector3d off = OffExpected(*model.expected, at);
  return log_prior - off.dot(model.expected->information * off) / 2;
}

/// Its share of gradient and information.
void AddPrior(const OutlineModel& model, const OutlineFit& at, OutlineSlope* slope) {
  slope->gradient[3] -= SpillSurprise(model, at) / model.spill_sigma_m;
  slope->gradient[4] -= ThicknessSurprise(model, at) / model.thickness_sigma_m;
  slope->fit.information(3, 3) += 1 / (model.spill_sigma_m * model.spill_sigma_m);
  slope->fit.information(4, 4) += 1 / (model.thickness_sigma_m * model.thickness_sigma_m);
  if (!model.expected) return;
  const ExpectedRectangle& expected = *model.expected;
  const Eigen::Matrix3d J = JacobianOfOff(expected, at);
  slope->gradient.head<3>() -= J.transpose() * expected.information * OffExpected(expected, at);
  slope->fit.information.topLeftCorner<3, 3>() += J.transpose() * expected.information * J;
}

/// Gradient and information, summed over beams.
struct SlopeSums {
  std::array<double, 5> gradient{};
  std::array<double, 15> information{};  // lower triangle, row by row

  void Add(const std::array<double, 5>& J, double pull, double weight) {
    std::size_t k = 0;
    for (std::size_t row = 0; row < 5; ++row) {
      gradient[row] += pull * J[row];
      const double weighted = weight * J[row];
      for (std::size_t col = 0; col <= row; ++col) information[k++] += weighted * J[col];
    }
  }

  void AddTo(OutlineSlope* slope) const {
    std::size_t k = 0;
    for (Eigen::Index row = 0; row < 5; ++row) {
      slope->gradient[row] += gradient[static_cast<std::size_t>(row)];
      for (Eigen::Index col = 0; col <= row; ++col, ++k) {
        slope->fit.information(row, col) += information[k];
        if (col != row) slope->fit.information(col, row) += information[k];
      }
    }
  }
};

}  // namespace

Eigen::Isometry2d RectanglePose::T_rectangle_plane() const {
  Eigen::Isometry2d T_plane_rectangle = Eigen::Isometry2d::Identity();
  T_plane_rectangle.linear() = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  T_plane_rectangle.translation() = centre_m;
  return T_plane_rectangle.inverse();
}

Eigen::Matrix3d OutlineFit::PoseCovariance() const {
  return information.inverse().topLeftCorner<3, 3>();
}

double OutlineLogLikelihood(const std::vector<OutlineBeam>& beams,
                            const OutlineModel& model,
                            const OutlineFit& at) {
  const double keep = 1.0 - model.stray_hits - model.stray_misses;
  LogProduct near_sides;
  const double others = BlurredRectangle(model, at).ForEachNear(beams, [&](const NearBeam& beam) {
    const double p_hit = model.stray_hits + keep * beam.Inside();
    near_sides.Add(beam.is_hit ? p_hit : 1.0 - p_hit);
  });
  return LogPrior(model, at) + others + near_sides.Value();
}

OutlineFit EvaluateOutline(const std::vector<OutlineBeam>& beams,
                           const OutlineModel& model,
                           const OutlineFit& at) {
  return DifferentiateOutline(beams, model, at).fit;
}

OutlineFit WithoutExpected(const OutlineModel& model, OutlineFit fit) {
  constexpr double kLeast = 1.0;  // per m2 or rad2: nothing is known
  const Eigen::Matrix3d J = JacobianOfOff(*model.expected, fit);
  const Eigen::Matrix3d with = fit.PoseCovariance().inverse();
  const Eigen::Matrix3d without = with - J.transpose() * model.expected->information * J;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(without);
  const Eigen::Matrix3d told = axes.eigenvectors() *
                               axes.eigenvalues().cwiseMax(kLeast).asDiagonal() *
                               axes.eigenvectors().transpose();
  fit.information.topLeftCorner<3, 3>() += told - with;
  return fit;
}

OutlineSlope DifferentiateOutline(const std::vector<OutlineBeam>& beams,
                                  const OutlineModel& model,
                                  const OutlineFit& at) {
  const double keep = 1.0 - model.stray_hits - model.stray_misses;
  const BlurredRectangle rectangle(model, at);
  const double bx = rectangle.per_blur.x();
  const double by = rectangle.per_blur.y();
  LogProduct near_sides;
  SlopeSums sums;
  const double others = rectangle.ForEachNear(beams, [&](const NearBeam& beam) {
    const double kept = keep * beam.Inside();
    const double p_hit = model.stray_hits + kept;
    near_sides.Add(beam.is_hit ? p_hit : 1.0 - p_hit);
    // d ln(kept) / d (distance inside each side); then the centre and the angle move q by -(1, 0),
    // -(0, 1) and (y, -x).
    const double d_right = beam.right.rest * bx;
    const double d_left = beam.left.rest * bx;
    const double d_top = beam.top.rest * by;
    const double d_bottom = beam.bottom.rest * by;
    const double d_x = d_left - d_right;
    const double d_y = d_bottom - d_top;
    const double d_spill =
        (d_right + d_left) * rectangle.stretch.x() + (d_top + d_bottom) * rectangle.stretch.y();
    const Eigen::Vector4d& lean = rectangle.side_lean;
    const double d_thickness =
        d_right * lean[0] + d_left * lean[1] + d_top * lean[2] + d_bottom * lean[3];
    const double per_variance = kept / (p_hit * (1.0 - p_hit));
    sums.Add({-d_x, -d_y, d_x * beam.y_m - d_y * beam.x_m, d_spill, d_thickness},
             per_variance * (beam.is_hit ? 1.0 - p_hit : -p_hit),
             per_variance * kept);
  });
  OutlineSlope slope;
  slope.fit.num_beams = beams.size();
  slope.fit.pose = at.pose;
  slope.fit.spill_m = at.spill_m;
  slope.fit.thickness_m = at.thickness_m;
  slope.fit.log_likelihood = LogPrior(model, at) + others + near_sides.Value();
  AddPrior(model, at, &slope);
  sums.AddTo(&slope);
  return slope;
}

}  // namespace voqcal
