#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace voqcal::detail {

/// What a lens does to a point q of its plane: with u = |q|^2 the distorted point is
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

/// Horner's scheme, lowest coefficient first.
template <std::size_t N, typename T>
T Polynomial(const std::array<double, N>& coefficients, const T& u) {
  T sum = T(coefficients[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * u + T(coefficients[i]);
  return sum;
}

template <typename T>
Eigen::Matrix<T, 2, 1> Distort(const Distortion& lens, const Eigen::Matrix<T, 2, 1>& q) {
  const T u = q(0) * q(0) + q(1) * q(1);
  const T xy2 = T(2) * q(0) * q(1);
  const T radial = Polynomial(lens.numerator, u) / Polynomial(lens.denominator, u);
  return {q(0) * radial + T(lens.p1) * xy2 + T(lens.p2) * (u + T(2) * q(0) * q(0)),
          q(1) * radial + T(lens.p1) * (u + T(2) * q(1) * q(1)) + T(lens.p2) * xy2};
}

/// True where the distorted radius still grows with the radius, all the way to q, and |q| is below
/// `max_radius`.
bool IsOnGrowingBranch(const Distortion& lens, double max_radius, const Eigen::Vector2d& q);

/// The q of the growing branch with Distort(q) = distorted; nothing if there is none.
std::optional<Eigen::Vector2d> Undistort(const Distortion& lens,
                                         double max_radius,
                                         const Eigen::Vector2d& distorted);

}  // namespace voqcal::detail
