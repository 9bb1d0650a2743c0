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
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = pose.ToRectangle(beam.position_m);
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
  agreement.hits_outside = outside[1] / std::max(outside[0] + outside[1], 1.0);
  for (const auto& row : is_covered) {
    agreement.covered +=
        static_cast<double>(std::count(row.begin(), row.end(), true)) / (kNumFields * kNumFields);
  }
  return agreement;
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
