#include "core/sampling/corner_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace voqcal {
namespace {

bool IsWhole(const CameraBoard& board) {
  return std::all_of(board.corners_px.begin(), board.corners_px.end(), [](const auto& corner_px) {
    return corner_px.allFinite();
  });
}

}  // namespace

double LargestCornerMotionPx(const CameraBoard& a, const CameraBoard& b) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (a.corners_px.size() != b.corners_px.size()) return kInfinite;
  if (a.corners_px.empty()) return 0.0;
  double same_px = 0;
  double turned_px = 0;  // the detector took the other half-turn
  int num_common = 0;
  const std::size_t n = a.corners_px.size();
  for (std::size_t i = 0; i < n; ++i) {
    turned_px = std::max(turned_px, (a.corners_px[i] - b.corners_px[n - 1 - i]).norm());
    const double motion_px = (a.corners_px[i] - b.corners_px[i]).norm();
    if (!std::isfinite(motion_px)) continue;
    same_px = std::max(same_px, motion_px);
    ++num_common;
  }
  // Only of whole patterns the half-turn may be unknown: a part is told by its markers.
  if (IsWhole(a) && IsWhole(b)) same_px = std::min(same_px, turned_px);
  return num_common > 0 ? same_px : kInfinite;
}

}  // namespace voqcal
