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
  constexpr int kNumFields = 4;
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
  for (const auto& row : is_covered) {
    agreement.covered +=
        static_cast<double>(std::count(row.begin(), row.end(), true)) / (kNumFields * kNumFields);
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

bool IsSeen(const OutlineEdge& edge) {
  constexpr int kMinMisses = 2;
  constexpr double kMaxShortM = 0.05;
  return edge.num_misses >= kMinMisses || edge.reach_m > -kMaxShortM;
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
