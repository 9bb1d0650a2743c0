#include "core/camera_detection/dark_squares.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

namespace voqcal {
namespace {

// An edge that leaves a corner along axes[1] or against it. The dark quarter beside it is the one
// swept from it towards pixel y, up to the edge against or along axes[0].
struct Leaving {
  std::size_t corner;
  float sign;

  bool operator==(const Leaving& other) const {
    return corner == other.corner && sign == other.sign;
  }
};

// Where the edge meets the next corner, and what leaves there around the same dark area.
std::optional<Leaving> Next(const std::vector<XCorner>& corners, const Leaving& edge) {
  constexpr float kMaxSlope = 0.15F;  // 9 degrees, what a corner's axes may be off
  constexpr float kMinCosine = 0.9F;  // 25 degrees: lenses bend edges
  const cv::Point2f direction = edge.sign * corners[edge.corner].axes[1];
  std::optional<Leaving> next;
  float nearest_px = HUGE_VALF;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const cv::Point2f to = corners[k].position_px - corners[edge.corner].position_px;
    const float along_px = to.dot(direction);
    if (along_px <= 0 || along_px >= nearest_px) continue;
    if (std::abs(static_cast<float>(direction.cross(to))) > kMaxSlope * along_px) continue;
    const float cosine = to.dot(corners[k].axes[0]) / std::hypot(to.x, to.y);
    if (std::abs(cosine) < kMinCosine) continue;
    nearest_px = along_px;
    next = Leaving{k, cosine > 0 ? 1.0F : -1.0F};
  }
  return next;
}

}  // namespace

std::vector<Square> DarkSquares(const std::vector<XCorner>& corners) {
  std::vector<Square> squares;
  for (std::size_t first = 0; first < corners.size(); ++first) {
    for (const float sign : {1.0F, -1.0F}) {
      std::optional<Leaving> edge = Leaving{first, sign};
      Square square;
      bool is_first_least = true;  // each square once
      for (cv::Point2f& corner_px : square) {
        if (!edge || edge->corner < first) is_first_least = false;
        if (!is_first_least) break;
        corner_px = corners[edge->corner].position_px;
        edge = Next(corners, *edge);
      }
      if (is_first_least && edge && *edge == Leaving{first, sign}) squares.push_back(square);
    }
  }
  return squares;
}

}  // namespace voqcal
