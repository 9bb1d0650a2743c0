#include "core/board/outline_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voqcal {

bool Agreement::IsBoardLike(double slack) const {
  constexpr double kMaxMissesInside = 0.15;
  constexpr double kMaxHitsOutside = 0.25;  // pole, hands and legs may lie in the plane
  return 1.0 - hits_inside <= slack * kMaxMissesInside && hits_outside <= slack * kMaxHitsOutside;
}

Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const RectanglePose& pose) {
  constexpr double kMarginM = 0.03;  // partly hit beams prove nothing
  constexpr double kBorderM = 0.20;  // how far around the board its surroundings are looked at
  constexpr std::size_t kNumFields = 4;
  constexpr double kFieldShare = 1.0 / (kNumFields * kNumFields);
  std::array<std::array<bool, kNumFields>, kNumFields> is_covered{};
  std::array<double, 2> inside{};
  std::array<double, 2> outside{};
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    const double out_m =
        std::max(std::abs(q_m.x()) - model.width_m / 2, std::abs(q_m.y()) - model.height_m / 2);
    if (out_m < -kMarginM) inside[beam.is_hit] += 1;
    if (out_m > kMarginM && out_m < kBorderM) outside[beam.is_hit] += 1;
    if (out_m >= 0 || !beam.is_hit) continue;
    const auto field = [](double q, double size_m) {
      return static_cast<std::size_t>(
          std::clamp((q / size_m + 0.5) * kNumFields, 0.0, kNumFields - 1.0));
    };
    is_covered[field(q_m.x(), model.width_m)][field(q_m.y(), model.height_m)] = true;
  }
  Agreement agreement;
  agreement.hits_inside = inside[1] / std::max(inside[0] + inside[1], 1.0);
  // Beams past the board that return nothing (the sky, a cropped cloud) are misses too: as many as
  // the density of beams inside suggests.
  const auto area_m2 = [&model](double grow_m) {
    return (model.width_m + 2 * grow_m) * (model.height_m + 2 * grow_m);
  };
  const double num_expected =
      (inside[0] + inside[1]) * (area_m2(kBorderM) - area_m2(kMarginM)) / area_m2(-kMarginM);
  agreement.hits_outside = outside[1] / std::max({outside[0] + outside[1], num_expected, 1.0});
  for (std::size_t x = 0; x < kNumFields; ++x) {
    for (std::size_t y = 0; y < kNumFields; ++y) {
      if (!is_covered[x][y]) continue;
      agreement.covered += kFieldShare;
      agreement.covered_half[x < kNumFields / 2 ? 3 : 1] += 2 * kFieldShare;
      agreement.covered_half[y < kNumFields / 2 ? 0 : 2] += 2 * kFieldShare;
    }
  }
  return agreement;
}

bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model) {
  constexpr double kMinHitsInside = 0.7;
  // A person and a pole in the plane fill a tenth of the surroundings; where these have no returns
  // (a cropped cloud, the sky), they are still few beside the board's own.
  constexpr double kMaxHitsOutside = 0.2;
  constexpr double kMaxHitsPerOwn = 0.3;
  const double shorter_m = std::min(model.width_m, model.height_m);
  const double off_m = shorter_m / 6;  // of the patch's middle from the board's
  const double inside_m = shorter_m / 2 - off_m;
  const double outside_m = std::hypot(model.width_m, model.height_m) / 2 + off_m;
  std::array<double, 2> inside{};
  std::array<double, 2> outside{};
  double num_own = 0.0;
  for (const OutlineBeam& beam : beams) {
    const double square_m2 = beam.position_m.squaredNorm();
    if (square_m2 < inside_m * inside_m) inside[beam.is_hit] += 1;
    if (square_m2 > outside_m * outside_m)
      outside[beam.is_hit] += 1;
    else
      num_own += beam.is_hit;
  }
  return inside[1] > 0 && inside[1] >= kMinHitsInside * (inside[0] + inside[1]) &&
         outside[1] <=
             std::max(kMaxHitsOutside * (outside[0] + outside[1]), kMaxHitsPerOwn * num_own);
}

bool IsClosed(const OutlineEdge& edge) {
  constexpr int kMinMisses = 2;
  return edge.num_misses >= kMinMisses;
}

std::optional<std::size_t> OpenEdge(const std::array<OutlineEdge, 4>& edges,
                                    const std::array<bool, 4>& is_covered,
                                    const Agreement& agreement,
                                    double max_short_m,
                                    double slack) {
  constexpr double kMinCovered = 0.8;
  std::optional<std::size_t> open;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_up_to_it = is_covered[i] && edges[i].reach_m > -slack * max_short_m;
    if (IsClosed(edges[i]) || is_up_to_it) continue;
    if (!open || edges[i].reach_m < edges[*open].reach_m) open = i;
  }
  if (open || agreement.covered >= kMinCovered / slack) return open;
  const auto& half = agreement.covered_half;
  return static_cast<std::size_t>(std::min_element(half.begin(), half.end()) - half.begin());
}

bool AreLengthsRight(const std::array<double, 4>& measured_m,
                     const std::array<OutlineEdge, 4>& edges,
                     const std::array<double, 4>& true_m) {
  struct Tolerance {
    double open_m;
    double num_sigmas;
    double largest_m;

    bool Holds(double error_m, double sigma_m) const {
      return std::abs(error_m) <= std::min(open_m + num_sigmas * sigma_m, largest_m);
    }
  };
  constexpr Tolerance kOfOne{0.03, 4.0, 0.15};
  constexpr Tolerance kOfMean{0.03, 1.5, 0.08};
  for (std::size_t i = 0; i < 2; ++i) {
    // Edge i and the one opposite reach from the edge before to the edge after.
    const double sigma_m =
        std::hypot(edges[(i + 3) % 4].offset_sigma_m, edges[i + 1].offset_sigma_m);
    const double error_m = measured_m[i] - true_m[i];
    const double opposite_error_m = measured_m[i + 2] - true_m[i + 2];
    if (!kOfOne.Holds(error_m, sigma_m) || !kOfOne.Holds(opposite_error_m, sigma_m) ||
        !kOfMean.Holds((error_m + opposite_error_m) / 2, sigma_m)) {
      return false;
    }
  }
  return true;
}

std::optional<std::size_t> ScreenedEdge(const std::vector<OutlineBeam>& beams,
                                        const std::vector<Eigen::Vector2d>& blocked_m,
                                        const OutlineModel& model,
                                        const RectanglePose& pose) {
  constexpr double kPastM = 0.15;
  constexpr int kMinBlocked = 3;  // fewer are stray
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  const Eigen::Array2d half_m(model.width_m / 2, model.height_m / 2);
  // The edge just past which a place is; none for the corners and for what is inside or far.
  const auto edge_before = [&](const Eigen::Vector2d& p_m) -> std::optional<std::size_t> {
    const Eigen::Vector2d q_m = T_rectangle_plane * p_m;
    const Eigen::Array2d out_m = q_m.array().abs() - half_m;
    if ((out_m > 0).all() || (out_m <= 0).all() || out_m.maxCoeff() > kPastM) return {};
    if (out_m.x() > 0) return q_m.x() > 0 ? 1 : 3;
    return q_m.y() > 0 ? 2 : 0;
  };
  std::array<int, 4> num_blocked{};
  std::array<int, 4> num_misses{};
  for (const Eigen::Vector2d& p_m : blocked_m) {
    if (const auto edge = edge_before(p_m)) ++num_blocked[*edge];
  }
  for (const OutlineBeam& beam : beams) {
    if (beam.is_hit) continue;
    if (const auto edge = edge_before(beam.position_m)) ++num_misses[*edge];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (num_blocked[i] >= kMinBlocked && num_blocked[i] > num_misses[i]) return i;
  }
  return {};
}

bool IsHidden(const std::vector<Eigen::Vector2d>& blocked_m,
              const OutlineModel& model,
              const RectanglePose& pose,
              std::size_t edge) {
  constexpr double kPastM = 0.1;
  constexpr std::ptrdiff_t kMinBlocked = 3;  // fewer are stray
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  const Eigen::Vector2d outward = OutwardOf(edge);
  const Eigen::Array2d half_m(model.width_m / 2, model.height_m / 2);
  const auto num = std::count_if(blocked_m.begin(), blocked_m.end(), [&](const auto& p_m) {
    const Eigen::Vector2d q_m = T_rectangle_plane * p_m;
    return outward.dot(q_m) > 0 && (q_m.array().abs() < half_m + kPastM).all();
  });
  return num >= kMinBlocked;
}

double LogLikelihoodOfChance(const std::vector<OutlineBeam>& beams) {
  const auto num_hits = static_cast<double>(
      std::count_if(beams.begin(), beams.end(), [](const auto& beam) { return beam.is_hit; }));
  const double num_misses = static_cast<double>(beams.size()) - num_hits;
  if (num_hits == 0 || num_misses == 0) return 0.0;
  const double num = num_hits + num_misses;
  return num_hits * std::log(num_hits / num) + num_misses * std::log(num_misses / num);
}

}  // namespace voqcal
