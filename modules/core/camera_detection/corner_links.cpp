#include "core/camera_detection/corner_links.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

constexpr float kMaxTangent = 0.36F;  // 20 degrees: twice what a ring of 16 pixels may be off
constexpr float kMaxSine = 0.5F;      // 30 degrees between edges across: perspective turns them
constexpr float kMaxContrastRatio = 3.0F;  // light changes slowly over a board

// Of many corners nearly none is another's next one. To see that of most at once, their numbers lie
// in rows, over which the compiler vectorises.
class Candidates {
 public:
  explicit Candidates(const std::vector<XCorner>& corners) : may_join_(corners.size()) {
    for (const XCorner& corner : corners) {
      x_.push_back(corner.position_px.x);
      y_.push_back(corner.position_px.y);
      for (int axis = 0; axis < 2; ++axis) {
        axis_x_[axis].push_back(corner.axes[axis].x);
        axis_y_[axis].push_back(corner.axes[axis].y);
      }
    }
  }

  // The indices of all that lie along an axis of `from` and MayJoin it, and of few others, in
  // order.
  const std::vector<int>& Of(const XCorner& from) {
    Mark(from);
    indices_.clear();
    for (std::size_t i = 0; i < may_join_.size(); ++i) {
      if (may_join_[i] != 0) indices_.push_back(static_cast<int>(i));
    }
    return indices_;
  }

 private:
  void Mark(const XCorner& from) {
    constexpr float kSlack = 1.001F;  // more than rounding makes of the exact limits
    const auto sine = [](float ax, float ay, float bx, float by) {
      return std::abs(ax * by - ay * bx);
    };
    const auto is_along = [&sine](float ax, float ay, float bx, float by) {
      return sine(ax, ay, bx, by) < kSlack * kMaxTangent * std::abs(ax * bx + ay * by);
    };
    const auto [a, b] = from.axes;
    for (std::size_t i = 0; i < may_join_.size(); ++i) {
      const float x = x_[i] - from.position_px.x;
      const float y = y_[i] - from.position_px.y;
      const float ax = axis_x_[0][i], ay = axis_y_[0][i];
      const float bx = axis_x_[1][i], by = axis_y_[1][i];
      const bool is_along_a = is_along(x, y, a.x, a.y) & is_along(x, y, bx, by) &
                              (sine(b.x, b.y, ax, ay) < kSlack * kMaxSine);
      const bool is_along_b = is_along(x, y, b.x, b.y) & is_along(x, y, ax, ay) &
                              (sine(a.x, a.y, bx, by) < kSlack * kMaxSine);
      may_join_[i] = is_along_a | is_along_b ? 1 : 0;
    }
  }

  std::vector<float> x_, y_;
  std::array<std::vector<float>, 2> axis_x_, axis_y_;
  std::vector<int> may_join_;
  std::vector<int> indices_;
};

CornerLinks NearestCorners(const std::vector<XCorner>& corners) {
  constexpr float kMinStepPx = 3.0F;
  const int num = static_cast<int>(corners.size());
  Candidates candidates(corners);
  CornerLinks links(corners.size());
  for (int p = 0; p < num; ++p) {
    std::array<float, kNumWays> nearest;
    nearest.fill(HUGE_VALF);
    links[p].fill(kNoCorner);
    for (const int q : candidates.Of(corners[p])) {
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
