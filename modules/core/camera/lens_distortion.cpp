#include "core/camera/lens_distortion.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <Eigen/LU>

namespace voqcal::detail {
namespace {

// A polynomial in u: coefficients of u^0 ... u^7. No lens' has a higher degree.
using Coefficients = std::array<double, 8>;

template <std::size_t N>
Coefficients Widened(const std::array<double, N>& polynomial) {
  Coefficients wide{};
  std::copy(polynomial.begin(), polynomial.end(), wide.begin());
  return wide;
}

Coefficients Product(const Coefficients& a, const Coefficients& b) {
  Coefficients product{};
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; i + j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

// 2 u P'(u): what the derivative of P(r^2) by r is, times r.
Coefficients RadiusTimesSlope(const Coefficients& polynomial) {
  Coefficients slope{};
  for (std::size_t i = 0; i < slope.size(); ++i)
    slope[i] = 2.0 * static_cast<double>(i) * polynomial[i];
  return slope;
}

// The sign of d/dr [r N(r^2) / M(r^2)], times M^2: (N + 2 u N') M - 2 u N M'.
// Degrees: rational 3 + 3, equidistant 4 + 0.
Coefficients RadialGrowth(const Distortion& lens) {
  const Coefficients numerator = Widened(lens.numerator);
  const Coefficients denominator = Widened(lens.denominator);
  Coefficients rising = RadiusTimesSlope(numerator);
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] += numerator[i];
  Coefficients growth = Product(rising, denominator);
  const Coefficients falling = Product(numerator, RadiusTimesSlope(denominator));
  for (std::size_t i = 0; i < growth.size(); ++i) growth[i] -= falling[i];
  return growth;
}

// A polynomial lies within the hull of its Bernstein coefficients, of which the first and last are
// its values at the ends; where the hull does not tell, both halves are asked (de Casteljau).
bool IsBernsteinPositive(const Coefficients& bernstein, int depth) {
  if (!(bernstein.front() > 0.0 && bernstein.back() > 0.0)) return false;
  if (*std::min_element(bernstein.begin(), bernstein.end()) > 0.0) return true;
  if (depth == 0) return false;  // it touches zero, as far as doubles can tell
  Coefficients left{};
  Coefficients right = bernstein;
  for (std::size_t level = 0; level < left.size(); ++level) {
    left[level] = right.front();
    for (std::size_t i = 0; i + 1 + level < right.size(); ++i)
      right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  return IsBernsteinPositive(left, depth - 1) && IsBernsteinPositive(right, depth - 1);
}

// True if the polynomial is positive on all of [0, u_end].
bool IsPositiveUpTo(const Coefficients& polynomial, double u_end) {
  constexpr int kMaxHalvings = 40;
  constexpr std::size_t kDegree = std::tuple_size<Coefficients>::value - 1;
  // b_i = sum over j <= i of (i over j) / (kDegree over j) a_j u_end^j, of the polynomial on [0,
  // u_end].
  Coefficients scaled{};
  double factor = 1.0;  // u_end^j / (kDegree over j)
  for (std::size_t j = 0; j <= kDegree; ++j) {
    scaled[j] = polynomial[j] * factor;
    factor *= u_end * static_cast<double>(j + 1) /
              static_cast<double>(kDegree - std::min(j, kDegree - 1));
  }
  Coefficients bernstein{};
  for (std::size_t i = 0; i <= kDegree; ++i) {
    double choose = 1.0;  // i over j
    for (std::size_t j = 0; j <= i; ++j) {
      bernstein[i] += choose * scaled[j];
      choose *= static_cast<double>(i - j) / static_cast<double>(j + 1);
    }
  }
  return IsBernsteinPositive(bernstein, kMaxHalvings);
}

// P'(u).
template <std::size_t N>
double Slope(const std::array<double, N>& polynomial, double u) {
  double sum = 0.0;
  for (std::size_t i = N - 1; i > 0; --i) sum = sum * u + static_cast<double>(i) * polynomial[i];
  return sum;
}

// Sums of |c_i| u^i and of 2 i |c_i| u^i, i > 0: how far P and 2 u P' can be from P(0) = 1 and 0.
template <std::size_t N>
std::pair<double, double> Reach(const std::array<double, N>& polynomial, double u) {
  double sum = 0.0;
  double slope = 0.0;
  double power = 1.0;
  for (std::size_t i = 1; i < N; ++i) {
    power *= u;
    sum += std::abs(polynomial[i]) * power;
    slope += 2.0 * static_cast<double>(i) * std::abs(polynomial[i]) * power;
  }
  return {sum, slope};
}

// Whether the coefficients are too small to turn the growth anywhere on [0, u]: true for nearly all
// points of nearly all lenses, and a tenth of the time of asking the polynomials.
bool IsPlainlyGrowing(const Distortion& lens, double u) {
  const auto [n, n_slope] = Reach(lens.numerator, u);
  const auto [m, m_slope] = Reach(lens.denominator, u);
  const double rising = 1.0 - n - n_slope;
  return rising > 0.0 && m < 1.0 && rising * (1.0 - m) > (1.0 + n) * m_slope;
}

// Whether the growth has turned at u itself: true for most of what lies behind a lens.
bool IsPlainlyShrinking(const Distortion& lens, double u) {
  const double n = Polynomial(lens.numerator, u);
  const double m = Polynomial(lens.denominator, u);
  const double rising = n + 2.0 * u * Slope(lens.numerator, u);
  return rising * m - n * 2.0 * u * Slope(lens.denominator, u) < 0.0;
}

// What decides, for one lens, whether a point q of the plane lies on the growing branch.
class Branch {
 public:
  Branch(const Distortion& lens, double max_radius)
      : max_radius_(max_radius),
        growth_(RadialGrowth(lens)),
        denominator_(Widened(lens.denominator)) {}

  bool Contains(const Eigen::Vector2d& q) const {
    const double u = q.squaredNorm();
    return std::isfinite(u) && u < max_radius_ * max_radius_ && IsPositiveUpTo(growth_, u) &&
           IsPositiveUpTo(denominator_, u);
  }

 private:
  double max_radius_;
  Coefficients growth_;
  Coefficients denominator_;
};

// Derivative of Distort by q.
Eigen::Matrix2d DistortJacobian(const Distortion& lens, const Eigen::Vector2d& q) {
  const double u = q.squaredNorm();
  const double n = Polynomial(lens.numerator, u);
  const double m = Polynomial(lens.denominator, u);
  const double radial_by_u =
      (Slope(lens.numerator, u) * m - n * Slope(lens.denominator, u)) / (m * m);
  Eigen::Matrix2d J = n / m * Eigen::Matrix2d::Identity() + 2.0 * radial_by_u * q * q.transpose();
  const double diagonal = 2.0 * (lens.p1 * q.x() + lens.p2 * q.y());
  J(0, 0) += 2.0 * lens.p1 * q.y() + 6.0 * lens.p2 * q.x();
  J(0, 1) += diagonal;
  J(1, 0) += diagonal;
  J(1, 1) += 6.0 * lens.p1 * q.y() + 2.0 * lens.p2 * q.x();
  return J;
}

}  // namespace

bool IsOnGrowingBranch(const Distortion& lens, double max_radius, const Eigen::Vector2d& q) {
  const double u = q.squaredNorm();
  if (!(u < max_radius * max_radius)) return false;
  if (IsPlainlyGrowing(lens, u)) return true;
  if (IsPlainlyShrinking(lens, u)) return false;
  return Branch(lens, max_radius).Contains(q);
}

// Newton with steps halved until they help and stay on the branch.
std::optional<Eigen::Vector2d> Undistort(const Distortion& lens,
                                         double max_radius,
                                         const Eigen::Vector2d& distorted) {
  constexpr int kMaxSteps = 50;
  constexpr int kMaxHalvings = 40;
  constexpr double kTolerance =
      1e-13;  // in the plane: below 1e-9 px for any focal length under 10,000
  const Branch branch(lens, max_radius);

  Eigen::Vector2d q = distorted;
  for (int i = 0; i < kMaxHalvings && !branch.Contains(q); ++i) q *= 0.5;
  Eigen::Vector2d error = Distort(lens, q) - distorted;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (error.norm() <= kTolerance * (1.0 + distorted.norm())) return q;
    Eigen::Vector2d delta = -DistortJacobian(lens, q).inverse() * error;
    bool has_improved = false;
    for (int i = 0; i < kMaxHalvings && !has_improved; ++i, delta *= 0.5) {
      const Eigen::Vector2d next = q + delta;
      if (!branch.Contains(next)) continue;
      const Eigen::Vector2d next_error = Distort(lens, next) - distorted;
      if (!(next_error.norm() < error.norm())) continue;
      q = next;
      error = next_error;
      has_improved = true;
    }
    if (!has_improved) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace voqcal::detail
