#include "core/lidar_detection/outline_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voqcal {

bool Agreement::IsBoardLike() const {
  constexpr double kMaxMissesInside = 0.15;
  constexpr double kMaxHitsOutside = 0.25;  // pole, hands and legs may lie in the plane
  return 1.0 - hits_inside <= kMaxMissesInside && hits_outside <= kMaxHitsOutside;
}

Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const std::vector<BlockedBeam>& blocked,
                  const OutlineModel& model,
                  const RectanglePose& pose) {
  constexpr double kMarginM = 0.03;  // partly hit beams prove nothing
  constexpr double kBorderM = 0.20;  // how far around the board its surroundings are looked at
  constexpr std::size_t kNumFields = 4;
  constexpr double kFieldShare = 1.0 / (kNumFields * kNumFields);
  enum class Field { kUnseen, kEmpty, kHit };
  std::array<std::array<Field, kNumFields>, kNumFields> fields{};
  std::array<double, 2> inside{};
  std::array<double, 2> outside{};
  const Eigen::Isometry2d T_rectangle_plane = pose.T_rectangle_plane();
  const auto mark = [&](const Eigen::Vector2d& q_m, Field field) {
    const auto along = [](double q, double size_m) {
      return static_cast<std::size_t>(
          std::clamp((q / size_m + 0.5) * kNumFields, 0.0, kNumFields - 1.0));
    };
    Field& seen = fields[along(q_m.x(), model.width_m)][along(q_m.y(), model.height_m)];
    seen = std::max(seen, field);
  };
  const auto outside_m_of = [&model](const Eigen::Vector2d& q_m) {
    return std::max(std::abs(q_m.x()) - model.width_m / 2, std::abs(q_m.y()) - model.height_m / 2);
  };
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    const double out_m = outside_m_of(q_m);
    if (out_m < -kMarginM) inside[beam.is_hit] += 1;
    if (out_m > kMarginM && out_m < kBorderM) outside[beam.is_hit] += 1;
    if (out_m < 0) mark(q_m, beam.is_hit ? Field::kHit : Field::kEmpty);
  }
  for (const BlockedBeam& beam : blocked) {
    const Eigen::Vector2d q_m = T_rectangle_plane * beam.position_m;
    if (outside_m_of(q_m) < 0) mark(q_m, Field::kEmpty);
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
  // Scan lines may be farther apart than a field is wide: what no beam meets between two hits is
  // taken for the board's.
  const auto is_covered = [&fields](std::size_t x, std::size_t y) {
    if (fields[x][y] != Field::kUnseen) return fields[x][y] == Field::kHit;
    const auto is_hit = [&fields](std::size_t i, std::size_t j) {
      return i < kNumFields && j < kNumFields && fields[i][j] == Field::kHit;
    };
    return (is_hit(x - 1, y) && is_hit(x + 1, y)) || (is_hit(x, y - 1) && is_hit(x, y + 1));
  };
  for (std::size_t x = 0; x < kNumFields; ++x) {
    for (std::size_t y = 0; y < kNumFields; ++y) {
      if (!is_covered(x, y)) {
        if (fields[x][y] == Field::kEmpty) agreement.empty += kFieldShare;
        continue;
      }
      agreement.covered += kFieldShare;
    }
  }
  return agreement;
}

bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model) {
  constexpr double kMinHitsInside = 0.7;
  // A person and a pole in the plane fill a tenth of the surroundings; where these have no returns
  // (a cropped cloud, the sky), they are still few beside the board's own.
  constexpr double kMaxHitsOutside = 0.5;
  constexpr double kMaxHitsPerOwn = 0.6;
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
  // The scan may leave a gap just there.
  return num_own > 0 && inside[1] >= kMinHitsInside * (inside[0] + inside[1]) &&
         outside[1] <=
             std::max(kMaxHitsOutside * (outside[0] + outside[1]), kMaxHitsPerOwn * num_own);
}

bool AreLengthsRight(const std::array<double, 4>& measured_m,
                     const std::array<OutlineEdge, 4>& edges,
                     const std::array<double, 4>& true_m,
                     const std::array<bool, 4>& is_told,
                     const LengthTolerance& of_one,
                     const LengthTolerance& of_mean) {
  const auto holds = [](const LengthTolerance& tolerance, double error_m, double sigma_m) {
    return std::abs(error_m) <=
           std::min(tolerance.open_m + tolerance.num_sigmas * sigma_m, tolerance.largest_m);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    // Edge i and the one opposite reach from the edge before to the edge after.
    if (!is_told[(i + 3) % 4] || !is_told[i + 1]) continue;
    const double sigma_m =
        std::hypot(edges[(i + 3) % 4].offset_sigma_m, edges[i + 1].offset_sigma_m);
    const double error_m = measured_m[i] - true_m[i];
    const double opposite_error_m = measured_m[i + 2] - true_m[i + 2];
    if (!holds(of_one, error_m, sigma_m) || !holds(of_one, opposite_error_m, sigma_m) ||
        !holds(of_mean, (error_m + opposite_error_m) / 2, sigma_m)) {
      return false;
    }
  }
  return true;
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
