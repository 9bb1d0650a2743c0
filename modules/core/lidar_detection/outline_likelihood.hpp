#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace voqcal {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// Where a beam meets the board's plane, and what it says: the board is there, or it is not.
struct OutlineBeam {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< In the plane's own axes.
  bool is_hit = false;  ///< The return lies on the plane; otherwise clearly behind it.
};

/// Where a beam would have met the plane that ended in front of it.
struct BlockedBeam {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double before_m = 0.0;  ///< How far from the plane it ended.
};

/// A rectangle in the plane.
struct RectanglePose {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double angle_rad = 0.0;  ///< From the plane's first axis to the rectangle's width.

  /// From the plane's axes to the rectangle's: x along the width, y along the height.
  Eigen::Isometry2d T_rectangle_plane() const;
};

/// Where a rectangle is expected: a pull that keeps a fit near where the beams do not tell.
struct ExpectedRectangle {
  RectanglePose pose;
  /// Of the rectangle's [x; y; angle] about it, x and y along its own axes (m, m, rad).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// Probability that a beam hits: the unit step at each side of the rectangle, blurred by the beam's
/// footprint, but for a share of beams that hit beyond or miss inside:
///     p = stray_hits + (1 - stray_hits - stray_misses) * prod_k L((m_k + grow_k) / blur_k),
///     L(t) = 1 / (1 + e^-t),  blur_k = blur_m * stretch_k,
///     grow_k = spill * stretch_k + thickness * lean_k
/// with m_k the distance inside side k. Two things make the board look larger than it is:
/// - Spill: a beam that is less than half on the board still returns its range, by the same across
/// the
///   beam on all sides; a board seen at a slant stretches the footprint.
/// - Thickness: behind the near sides of a slanted board its side faces come into view; they shift
/// the
///   centre towards the sensor's side by half of thickness * tan(slant), millimetres on a foam
///   board.
/// Both are fitted along, near what is expected.
struct OutlineModel {
  double width_m = 0.0;
  double height_m = 0.0;
  double blur_m = 0.01;
  /// Beams that hit beyond the rectangle: more where things may touch it in its plane...
  double stray_hits = 0.01;
  double stray_misses = 0.01;  ///< ...and that miss inside: the board has no holes.
  double spill_m = 0.0;        ///< Expected, with 1 sigma.
  double spill_sigma_m = 0.002;
  double thickness_m = 0.0;  ///< Expected, with 1 sigma.
  double thickness_sigma_m = 0.01;
  /// Ray to the board's centre over its depth below the face, along the rectangle's axes: how far
  /// the ray moves in the plane for each metre that it passes through the board.
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();
  std::optional<ExpectedRectangle> expected;

  /// Along x and y: a direction w in the plane, seen at lean s, is stretched by sqrt(1 + (w .
  /// s)^2).
  Eigen::Vector2d Stretch() const { return (1.0 + lean.array().square()).sqrt(); }
  /// Lean of the sides in the order right, left, top, bottom; zero for the far sides.
  Eigen::Vector4d SideLean() const {
    return Eigen::Vector4d(-lean.x(), lean.x(), -lean.y(), lean.y()).cwiseMax(0.0);
  }
};

struct OutlineFit {
  RectanglePose pose;
  double spill_m = 0.0;
  double thickness_m = 0.0;
  double log_likelihood = 0.0;
  std::size_t num_beams = 0;  ///< That the likelihood is of.
  /// Fisher information of [x; y; angle; spill; thickness], x and y along the rectangle's axes
  /// (m, m, rad, m, m).
  Matrix5d information = Matrix5d::Zero();

  /// Mean surprise of a beam, in nats: 0 where the rectangle explains everything.
  double Unexplained() const {
    return num_beams == 0 ? 0.0 : -log_likelihood / static_cast<double>(num_beams);
  }

  /// Of [x; y; angle], spill and thickness being uncertain.
  Eigen::Matrix3d PoseCovariance() const;
};

/// The log-likelihood of `beams` at `at`'s pose, spill and thickness.
double OutlineLogLikelihood(const std::vector<OutlineBeam>& beams,
                            const OutlineModel& model,
                            const OutlineFit& at);

/// The log-likelihood and its curvature there.
OutlineFit EvaluateOutline(const std::vector<OutlineBeam>& beams,
                           const OutlineModel& model,
                           const OutlineFit& at);

/// What the beams alone tell of the pose: the pull of model.expected taken out of the information.
OutlineFit WithoutExpected(const OutlineModel& model, OutlineFit fit);

/// A place on the likelihood and which way is up.
struct OutlineSlope {
  OutlineFit fit;
  Vector5d gradient = Vector5d::Zero();  ///< By the parameters of OutlineFit::information.
};

OutlineSlope DifferentiateOutline(const std::vector<OutlineBeam>& beams,
                                  const OutlineModel& model,
                                  const OutlineFit& at);

}  // namespace voqcal
