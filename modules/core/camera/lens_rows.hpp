#pragma once

// One row a lens model: all that is particular to it. To add one: a row here, its name in LensRows
// and in LensModel.

#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/camera/lens_distortion.hpp"

namespace voqcal::detail {

using Coefficients = std::array<double, 8>;

// Each row has:
//   kLens, kName, kOtherName      how it is called: ours, and by other tools
//   kNumDistortion                how many coefficients it takes
//   PlaneFromPoint(point)         where the point is in the plane that the lens distorts; a
//                                 template, so that Jets of Ceres make the Jacobian
//   DistortionOf(k)               what the lens does to that plane, at focal length 1
//   IsProjectable(point)          whether that is defined and smooth, cheaply
//   kMaxRadius                    of the plane's points that are seen, HUGE_VAL for any
//   Unproject(k, at)              the unit ray of a point at focal length 1

/// q = x / z, y / z; OpenCV's polynomials of it.
struct Pinhole {
  static constexpr double kMaxRadius = HUGE_VAL;

  static Distortion DistortionOf(const Coefficients& k) {
    // Of plumb_bob, k[5], k[6] and k[7] are zero.
    return {{1, k[0], k[1], k[4], 0}, {1, k[5], k[6], k[7]}, k[2], k[3]};
  }

  template <typename T>
  static Eigen::Matrix<T, 2, 1> PlaneFromPoint(const Eigen::Matrix<T, 3, 1>& point) {
    const T scale = T(1) / point(2);
    return {point(0) * scale, point(1) * scale};
  }

  static bool IsProjectable(const Eigen::Vector3d& point) { return point.z() > 0.0; }

  static std::optional<Eigen::Vector3d> Unproject(const Coefficients& k,
                                                  const Eigen::Vector2d& at) {
    const auto q = Undistort(DistortionOf(k), HUGE_VAL, at);
    if (!q) return std::nullopt;
    return q->homogeneous().normalized();
  }
};

struct PlumbBob : Pinhole {
  static constexpr LensModel kLens = LensModel::kPlumbBob;
  static constexpr const char* kName = "plumb_bob";
  static constexpr const char* kOtherName = "plumb_bob";
  static constexpr int kNumDistortion = 5;
};

struct Rational : Pinhole {
  static constexpr LensModel kLens = LensModel::kRational;
  static constexpr const char* kName = "rational";
  static constexpr const char* kOtherName = "rational_polynomial";
  static constexpr int kNumDistortion = 8;
};

/// q = theta times the direction off the axis, to any angle but straight back.
struct Equidistant {
  static constexpr LensModel kLens = LensModel::kEquidistant;
  static constexpr const char* kName = "equidistant";
  static constexpr const char* kOtherName = "fisheye";
  static constexpr int kNumDistortion = 4;
  static constexpr double kMaxRadius = M_PI;

  static Distortion DistortionOf(const Coefficients& k) {
    return {{1, k[0], k[1], k[2], k[3]}, {1, 0, 0, 0}, 0, 0};
  }

  template <typename T>
  static bool IsOnAxis(const Eigen::Matrix<T, 3, 1>& point) {
    return !(point(0) * point(0) + point(1) * point(1) > T(1e-20) * point(2) * point(2));
  }

  template <typename T>
  static Eigen::Matrix<T, 2, 1> PlaneFromPoint(const Eigen::Matrix<T, 3, 1>& point) {
    using std::atan2;
    using std::sqrt;
    T scale = T(1) / point(2);
    // On the axis theta / r is 0 / 0 and sqrt has no derivative; there theta / r = 1 / z to
    // rounding, as the next term of its series is r^2 / (3 z^2) < 1e-20.
    if (!IsOnAxis(point)) {
      const T r = sqrt(point(0) * point(0) + point(1) * point(1));
      scale = atan2(r, point(2)) / r;
    }
    return {point(0) * scale, point(1) * scale};
  }

  static bool IsProjectable(const Eigen::Vector3d& point) {
    return point.z() > 0.0 || !IsOnAxis(point);
  }

  static std::optional<Eigen::Vector3d> Unproject(const Coefficients& k,
                                                  const Eigen::Vector2d& at) {
    const auto q = Undistort(DistortionOf(k), kMaxRadius, at);
    if (!q) return std::nullopt;
    const double theta_rad = q->norm();
    if (theta_rad < 1e-12) return q->homogeneous();
    const Eigen::Vector2d off_axis = *q * (std::sin(theta_rad) / theta_rad);
    return Eigen::Vector3d(off_axis.x(), off_axis.y(), std::cos(theta_rad));
  }
};

using LensRows = std::tuple<Equidistant, PlumbBob, Rational>;

/// What `use` says of the row of that lens.
template <std::size_t I = 0, typename Use>
auto WithLens(LensModel lens, const Use& use) {
  using Row = std::tuple_element_t<I, LensRows>;
  if constexpr (I + 1 < std::tuple_size_v<LensRows>) {
    if (lens != Row::kLens) return WithLens<I + 1>(lens, use);
  }
  return use(Row{});
}

/// The number itself, and that of a Jet.
inline double ValueOf(double number) { return number; }
template <typename Jet>
double ValueOf(const Jet& jet) {
  return jet.a;
}

/// Where the row's lens brings a point, at focal length 1.
template <typename Row, typename T>
Eigen::Matrix<T, 2, 1> ProjectBy(const Row& /*row*/,
                                 const Coefficients& k,
                                 const Eigen::Matrix<T, 3, 1>& point) {
  return Distort(Row::DistortionOf(k), Row::PlaneFromPoint(point));
}

/// Whether it brings the point's ray to a pixel.
template <typename Row>
bool IsSeenBy(const Row& /*row*/, const Coefficients& k, const Eigen::Vector3d& point) {
  return Row::IsProjectable(point) &&
         IsOnGrowingBranch(Row::DistortionOf(k), Row::kMaxRadius, Row::PlaneFromPoint(point));
}

/// ProjectBy where IsSeenBy.
template <typename Row, typename T>
std::optional<Eigen::Matrix<T, 2, 1>> ProjectIfSeenBy(const Row& /*row*/,
                                                      const Coefficients& k,
                                                      const Eigen::Matrix<T, 3, 1>& point) {
  if (!Row::IsProjectable({ValueOf(point(0)), ValueOf(point(1)), ValueOf(point(2))})) {
    return std::nullopt;
  }
  const Distortion distortion = Row::DistortionOf(k);
  const Eigen::Matrix<T, 2, 1> q = Row::PlaneFromPoint(point);
  if (!IsOnGrowingBranch(distortion, Row::kMaxRadius, {ValueOf(q(0)), ValueOf(q(1))})) {
    return std::nullopt;
  }
  return Distort(distortion, q);
}

}  // namespace voqcal::detail
