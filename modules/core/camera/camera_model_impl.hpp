#pragma once

// Templates of camera_model.hpp, which includes this file.

#include <array>
#include <cmath>

#include "core/camera/camera_model.hpp"

namespace voqcal {
namespace detail {

/// The three lens models in one form. A ray becomes a point q of a plane (PlaneFromPoint), and with
/// u = |q|^2 the distorted point is
///     d = q * N(u) / M(u) + [2 p1 qx qy + p2 (u + 2 qx^2); p1 (u + 2 qy^2) + 2 p2 qx qy]
/// plumb_bob, rational: OpenCV, "Camera Calibration and 3D Reconstruction", Detailed Description.
/// equidistant: OpenCV, "Fisheye camera model", theta_d = theta (1 + k1 theta^2 + ... + k4
/// theta^8); there |q| is theta, M = 1 and p1 = p2 = 0.
struct Distortion {
  std::array<double, 5> numerator{1, 0, 0, 0, 0};  ///< N: coefficients of u^0 ... u^4.
  std::array<double, 4> denominator{1, 0, 0, 0};   ///< M: coefficients of u^0 ... u^3.
  double p1 = 0.0;
  double p2 = 0.0;
};

inline Distortion DistortionOf(const CameraModel& camera) {
  const auto& k = camera.distortion;
  if (camera.lens == LensModel::kEquidistant)
    return {{1, k[0], k[1], k[2], k[3]}, {1, 0, 0, 0}, 0, 0};
  // Of plumb_bob, k[5], k[6] and k[7] are zero.
  return {{1, k[0], k[1], k[4], 0}, {1, k[5], k[6], k[7]}, k[2], k[3]};
}

/// Horner's scheme, lowest coefficient first.
template <std::size_t N, typename T>
T Polynomial(const std::array<double, N>& coefficients, const T& u) {
  T sum = T(coefficients[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * u + T(coefficients[i]);
  return sum;
}

/// q of a point: theta times the direction off the axis (equidistant), or x / z, y / z.
template <typename T>
Eigen::Matrix<T, 2, 1> PlaneFromPoint(LensModel lens, const Eigen::Matrix<T, 3, 1>& point) {
  using std::atan2;
  using std::sqrt;
  const T& z = point(2);
  T scale = T(1) / z;
  const T r2 = point(0) * point(0) + point(1) * point(1);
  // On the axis theta / r is 0 / 0 and sqrt has no derivative; there theta / r = 1 / z to rounding,
  // as the next term of its series is r^2 / (3 z^2) < 1e-20.
  if (lens == LensModel::kEquidistant && r2 > T(1e-20) * z * z) {
    const T r = sqrt(r2);
    scale = atan2(r, z) / r;
  }
  return {point(0) * scale, point(1) * scale};
}

template <typename T>
Eigen::Matrix<T, 2, 1> Distort(const Distortion& lens, const Eigen::Matrix<T, 2, 1>& q) {
  const T u = q(0) * q(0) + q(1) * q(1);
  const T xy2 = T(2) * q(0) * q(1);
  const T radial = Polynomial(lens.numerator, u) / Polynomial(lens.denominator, u);
  return {q(0) * radial + T(lens.p1) * xy2 + T(lens.p2) * (u + T(2) * q(0) * q(0)),
          q(1) * radial + T(lens.p1) * (u + T(2) * q(1) * q(1)) + T(lens.p2) * xy2};
}

}  // namespace detail

template <typename T>
Eigen::Matrix<T, 2, 1> CameraModel::Project(const Eigen::Matrix<T, 3, 1>& point_camera_m) const {
  const Eigen::Matrix<T, 2, 1> d =
      detail::Distort(detail::DistortionOf(*this), detail::PlaneFromPoint(lens, point_camera_m));
  return {T(fx_px) * d(0) + T(cx_px), T(fy_px) * d(1) + T(cy_px)};
}

}  // namespace voqcal
