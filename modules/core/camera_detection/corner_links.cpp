#include "core/camera_detection/corner_links.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

CornerLinks NearestCorners(const std::vector<XCorner>& corners) {
  constexpr float kMaxTangent = 0.36F;
  constexpr float kMinStepPx = 3.0F;
  const int num = static_cast<int>(corners.size());
  CornerLinks links(corners.size());
  for (int p = 0; p < num; ++p) {
    std::array<float, kNumWays> nearest;
    nearest.fill(HUGE_VALF);
    links[p].fill(kNoCorner);
    for (int q = 0; q < num; ++q) {
      const cv::Point2f step = corners[q].position_px - corners[p].position_px;
      const float distance2 = step.dot(step);
      if (distance2 < kMinStepPx * kMinStepPx) continue;
      const std::array<float, 2> along{step.dot(corners[p].axes[0]), step.dot(corners[p].axes[1])};
      for (int axis = 0; axis < 2; ++axis) {
        const int way = along[axis] > 0 ? axis : axis + 2;
        if (distance2 >= nearest[way]) continue;
        if (std::abs(step.cross(corners[p].axes[axis])) >= kMaxTangent * std::abs(along[axis])) {
          continue;
        }
        if (!MayJoin(corners[p], corners[q], way, step)) continue;
        nearest[way] = distance2;
        links[p][way] = q;
      }
    }
  }
  return links;
}

// Drops links that are much longer than the link the other way: from a board's rim, such a link
// leads to some corner of the room.
CornerLinks WithoutLeaps(const std::vector<XCorner>& corners, const CornerLinks& links) {
  constexpr float kMaxStepRatio = 1.6F;  // of neighbouring squares, however tilted the board
  const auto length_px = [&](std::size_t p, int q) {
    const cv::Point2f step = corners[p].position_px - corners[q].position_px;
    return std::hypot(step.x, step.y);
  };
  CornerLinks kept = links;
  for (std::size_t p = 0; p < links.size(); ++p) {
    for (int way = 0; way < kNumWays; ++way) {
      const int q = links[p][way];
      const int other = links[p][(way + 2) % kNumWays];
      if (q == kNoCorner || other == kNoCorner) continue;
      if (length_px(p, q) > kMaxStepRatio * length_px(p, other)) kept[p][way] = kNoCorner;
    }
  }
  return kept;
}

// Keeps the links that lead back.
CornerLinks Mutual(const CornerLinks& links) {
  CornerLinks mutual = links;
  for (std::size_t p = 0; p < links.size(); ++p) {
    for (int& q : mutual[p]) {
      if (q == kNoCorner) continue;
      const auto& back = links[q];
      if (std::find(back.begin(), back.end(), static_cast<int>(p)) == back.end()) q = kNoCorner;
    }
  }
  return mutual;
}

}  // namespace

bool MayJoin(const XCorner& from, const XCorner& to, int way, const cv::Point2f& step) {
  constexpr float kMaxTangent = 0.36F;    // 20 degrees: twice what a ring of 16 pixels may be off
  constexpr float kMaxSine = 0.5F;        // 30 degrees between edges across: perspective turns them
  constexpr float kMaxContrastRatio = 3;  // light changes slowly over a board
  const cv::Point2f& other = to.axes[1 - way % 2];
  return std::abs(step.cross(other)) < kMaxTangent * std::abs(step.dot(other)) &&
         std::abs(from.axes[1 - way % 2].cross(to.axes[way % 2])) < kMaxSine &&
         to.contrast < kMaxContrastRatio * from.contrast &&
         from.contrast < kMaxContrastRatio * to.contrast;
}

CornerLinks LinkCorners(const std::vector<XCorner>& corners) {
  return Mutual(WithoutLeaps(corners, Mutual(NearestCorners(corners))));
}

}  // namespace voqcal
