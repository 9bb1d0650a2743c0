#include "core/lidar_detection/board_bend.hpp"

#include <cmath>
#include <cstddef>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace voqcal {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What the six coefficients are multiplied by at one place.
Vector6 Terms(double u, double v) {
  Vector6 terms;
  terms << 1.0, u, v, u * u, u * v, v * v;
  return terms;
}

/// The quadratic terms only.
Vector6 BendTerms(double u, double v) {
  Vector6 terms = Terms(u, v);
  terms.head<3>().setZero();
  return terms;
}

/// Highest minus lowest place: what it is of the coefficients.
Vector6 PeakToPeak(const Vector6& surface) {
  constexpr int kHalf = 4;  // places from the middle to each side
  Vector6 highest = BendTerms(0, 0);
  Vector6 lowest = highest;
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      const Vector6 terms =
          BendTerms(static_cast<double>(i) / kHalf, static_cast<double>(j) / kHalf);
      if (terms.dot(surface) > highest.dot(surface)) highest = terms;
      if (terms.dot(surface) < lowest.dot(surface)) lowest = terms;
    }
  }
  return highest - lowest;
}

}  // namespace

BoardBend MeasureBend(const std::vector<Eigen::Vector3d>& points_board_m,
                      const std::vector<std::uint16_t>& rings,
                      double width_m,
                      double height_m) {
  const auto terms_at = [&](std::size_t i) {
    return Terms(2 * points_board_m[i].x() / width_m, 2 * points_board_m[i].y() / height_m);
  };
  // Seen along lines, some shapes hardly leave a trace; a metre of bend is no news of a board.
  Matrix6 information = 1e-6 * Matrix6::Identity();
  Vector6 right = Vector6::Zero();
  for (std::size_t i = 0; i < points_board_m.size(); ++i) {
    const Vector6 terms = terms_at(i);
    information += terms * terms.transpose();
    right += points_board_m[i].z() * terms;
  }
  const Matrix6 inverse = information.inverse();
  const Vector6 surface = inverse * right;

  std::map<std::uint32_t, Vector6> scores;  // of each draw
  for (std::size_t i = 0; i < points_board_m.size(); ++i) {
    const Vector6 terms = terms_at(i);
    const double residual_m = points_board_m[i].z() - terms.dot(surface);
    const auto draw = rings.empty() ? static_cast<std::uint32_t>(i) : rings[i];
    scores.try_emplace(draw, Vector6::Zero()).first->second += residual_m * terms;
  }
  Matrix6 spread = Matrix6::Zero();
  for (const auto& [draw, score] : scores) spread += score * score.transpose();
  const auto num_draws = static_cast<double>(scores.size());
  // Six draws are spent on the surface itself.
  const double inflation = num_draws > 6 ? num_draws / (num_draws - 6) : 1e6;
  const Vector6 height = PeakToPeak(surface);
  return {height.dot(surface),
          std::sqrt(inflation * height.dot(inverse * spread * inverse * height))};
}

}  // namespace voqcal
