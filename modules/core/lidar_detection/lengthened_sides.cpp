#include "core/lidar_detection/lengthened_sides.hpp"

#include <array>
#include <cstddef>
#include <optional>

#include "core/lidar_detection/detection_tolerances.hpp"
#include "core/lidar_detection/outline_edges.hpp"

namespace voqcal {
namespace {

/// How much farther apart than the board's side `side` and the one opposite look; nothing if one of
/// them was not measured well.
std::optional<double> FartherApartM(const Measurement& m,
                                    const std::array<OutlineEdge, 4>& edges,
                                    std::size_t side) {
  constexpr double kMaxSigmaM = 0.05;
  double farther_m = 0.0;
  for (const std::size_t i : {side, (side + 2) % 4}) {
    if (m.sides[i].view != SideView::kMeasured || edges[i].offset_sigma_m > kMaxSigmaM) return {};
    farther_m += edges[i].offset_m;
  }
  return farther_m;
}

/// How much longer than it is the board looks along the rectangle's x and y, beyond what both share
/// (spill, thickness); 0 where that is not known.
Eigen::Vector2d LengthenedM(const Measurement& m) {
  const auto edges = MeasureEdges(m.telling, m.model, m.outline.pose);
  const std::optional<double> x_m = FartherApartM(m, edges, 1);
  const std::optional<double> y_m = FartherApartM(m, edges, 0);
  return {x_m ? *x_m - y_m.value_or(0.0) : 0.0, y_m ? *y_m - x_m.value_or(0.0) : 0.0};
}

}  // namespace

void OpenLengthenedSides(Measurement* m) {
  constexpr int kFew = 2;  // hits well past a side may be stray
  const Eigen::Vector2d lengthened_m = LengthenedM(*m);
  bool is_any_opened = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_beside = i % 2 == 1;
    const int num_joined = m->sides[i].num_joined;
    const bool is_joined = num_joined > m->sides[(i + 2) % 4].num_joined || num_joined > kFew;
    if (!is_joined || (is_beside ? lengthened_m.x() : lengthened_m.y()) < kLengthenedM) continue;
    m->sides[i].view = SideView::kJoined;
    m->sides[i].past.fill(SideEvidence::Past::kPlane);
    is_any_opened = true;
  }
  if (!is_any_opened) return;
  m->telling = TellingBeams(m->view.Outline(), m->model, m->outline.pose, m->sides);
}

Eigen::Vector2d LengtheningSigmaM(const Measurement& m) {
  return LengthenedM(m).unaryExpr(
      [](double longer_m) { return longer_m < kLengthenedM ? 0.0 : longer_m / 2; });
}

}  // namespace voqcal
