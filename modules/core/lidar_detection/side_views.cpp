#include "core/lidar_detection/side_views.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/lidar_detection/detection_tolerances.hpp"

namespace voqcal {
namespace {

using Past = SideEvidence::Past;

/// Beside a side: how far outside, and which of its parts.
struct Place {
  std::size_t side;
  std::size_t part;
  double outside_m;
};

/// A rectangle's sides, for many beams.
class SidePlaces {
 public:
  SidePlaces(const OutlineModel& model, const RectanglePose& pose)
      : T_rectangle_plane_(pose.T_rectangle_plane()),
        half_m_(model.width_m / 2, model.height_m / 2) {}

  Eigen::Vector2d ToRectangle(const Eigen::Vector2d& p_m) const { return T_rectangle_plane_ * p_m; }
  Eigen::Array2d OutsideM(const Eigen::Vector2d& q_m) const { return q_m.array().abs() - half_m_; }

  /// Nothing beyond the corners, where two sides meet.
  std::optional<Place> At(const Eigen::Vector2d& q_m, std::size_t side) const {
    const bool is_beside = side % 2 == 1;
    const double across_m = is_beside ? q_m.x() : q_m.y();
    // OutwardOf(side).dot(q_m): asked of each beam four times.
    const double outward_m = side == 1 || side == 2 ? across_m : -across_m;
    const double along = is_beside ? q_m.y() / half_m_.y() : q_m.x() / half_m_.x();
    if (std::abs(along) > 1.0) return {};
    const double share = (along + 1.0) / 2.0 * static_cast<double>(SideEvidence::kNumParts);
    const auto part = std::min(static_cast<std::size_t>(share), SideEvidence::kNumParts - 1);
    return Place{side, part, outward_m - (is_beside ? half_m_.x() : half_m_.y())};
  }

 private:
  Eigen::Isometry2d T_rectangle_plane_;
  Eigen::Array2d half_m_;
};

struct PartCount {
  int num_hits = 0;
  int num_misses = 0;
  int num_touching = 0;
  int num_before = 0;

  int Num() const { return num_hits + num_misses + num_touching + num_before; }
  Past What() const {
    if (Num() == 0) return Past::kUnseen;
    if (num_misses > num_hits + num_touching + num_before) return Past::kNothing;
    if (num_hits > 0 && num_hits >= num_touching + num_before) return Past::kPlane;
    return num_touching >= num_before ? Past::kTouch : Past::kBefore;
  }
};

/// The ground comes up to a board's foot, however flatly the beams meet it.
bool Touches(const BlockedBeam& beam, double outside_m) {
  constexpr double kGapM = 0.1;
  constexpr double kFlattest = 8.0;  // before the plane for each metre past the side
  return beam.before_m < kGapM + kFlattest * std::max(outside_m, 0.0);
}

struct SideCount {
  std::array<PartCount, SideEvidence::kNumParts> near, far;
  int num_blocked_inside = 0;
  int num_joined = 0;
  double reach_m = -1e9;

  const PartCount& Part(std::size_t i) const { return near[i].Num() > 0 ? near[i] : far[i]; }
};

SideView ViewOf(const SideEvidence& side, const SideCount& count, double max_short_m) {
  constexpr int kMinMisses = 2;  // one may be stray
  constexpr int kMinParts = 2;
  int num_misses = 0;
  for (std::size_t i = 0; i < SideEvidence::kNumParts; ++i) num_misses += count.Part(i).num_misses;
  const int num_joined = side.Count(Past::kPlane) + side.Count(Past::kTouch);
  const int num_before = side.Count(Past::kBefore);
  const int num_shown = side.Count(Past::kNothing);
  const bool is_reached = -side.reach_m < max_short_m;
  const bool is_near = -side.reach_m < kJustPastM;  // scan lines may be so far apart
  const bool is_shown = num_shown >= kMinParts || (num_shown > 0 && num_joined + num_before == 0);
  if (is_near && is_shown && num_misses >= kMinMisses) return SideView::kMeasured;
  if (!is_reached && count.num_blocked_inside > 2) return SideView::kHidden;
  // A hand before or in the plane, and nothing else past a side: a cropped cloud, as a rule.
  const bool is_unseen = side.Count(Past::kUnseen) > num_joined + num_before + num_shown;
  if (is_unseen) return num_misses > 0 ? SideView::kGap : SideView::kCutOff;
  if (num_joined > 0 && num_joined >= num_before) return SideView::kJoined;
  if (num_before > 0) return SideView::kHidden;
  return num_shown + num_misses > 0 ? SideView::kGap : SideView::kCutOff;
}

}  // namespace

int SideEvidence::Count(Past what) const {
  return static_cast<int>(std::count(past.begin(), past.end(), what));
}

std::array<SideEvidence, 4> LookAtSides(const std::vector<OutlineBeam>& beams,
                                        const std::vector<BlockedBeam>& blocked,
                                        const OutlineModel& model,
                                        const RectanglePose& pose,
                                        double spacing_m) {
  const SidePlaces places(model, pose);
  std::array<SideCount, 4> counts{};
  const auto part_at = [&](const Place& place) -> PartCount* {
    if (place.outside_m > kFarPastM) return nullptr;
    SideCount& count = counts[place.side];
    return &(place.outside_m < kJustPastM ? count.near : count.far)[place.part];
  };
  for (const OutlineBeam& beam : beams) {
    const Eigen::Vector2d q_m = places.ToRectangle(beam.position_m);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto place = places.At(q_m, i);
      if (!place) continue;
      if (beam.is_hit && place->outside_m < kSideMarginM) {
        counts[i].reach_m = std::max(counts[i].reach_m, place->outside_m);
        continue;
      }
      if (place->outside_m < 0) continue;
      PartCount* part = part_at(*place);
      if (part != nullptr && beam.is_hit) counts[i].num_joined += place->outside_m > kWellPastM;
      if (part != nullptr) ++(beam.is_hit ? part->num_hits : part->num_misses);
    }
  }
  for (const BlockedBeam& beam : blocked) {
    const Eigen::Vector2d q_m = places.ToRectangle(beam.position_m);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto place = places.At(q_m, i);
      if (!place) continue;
      if (place->outside_m < 0) {
        counts[i].num_blocked_inside += place->outside_m > -kJustPastM;
        continue;
      }
      PartCount* part = part_at(*place);
      if (part == nullptr) continue;
      ++(Touches(beam, place->outside_m) ? part->num_touching : part->num_before);
    }
  }
  const double max_short_m = std::max(kMaxShortM, kMaxShortSpacings * spacing_m);
  std::array<SideEvidence, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    sides[i].reach_m = counts[i].reach_m;
    sides[i].num_joined = counts[i].num_joined;
    for (std::size_t k = 0; k < SideEvidence::kNumParts; ++k) {
      sides[i].past[k] = counts[i].Part(k).What();
    }
    sides[i].view = ViewOf(sides[i], counts[i], max_short_m);
  }
  return sides;
}

std::vector<OutlineBeam> TellingBeams(const std::vector<OutlineBeam>& beams,
                                      const OutlineModel& model,
                                      const RectanglePose& pose,
                                      const std::array<SideEvidence, 4>& sides) {
  const SidePlaces places(model, pose);
  // Where the view ends hits may be of something else; in a cropped cloud they are all there is.
  std::array<bool, 4> is_cut_off{};
  for (std::size_t i = 0; i < 4; ++i) {
    const SideView opposite = sides[(i + 2) % 4].view;
    is_cut_off[i] = sides[i].view == SideView::kCutOff &&
                    (opposite == SideView::kMeasured || opposite == SideView::kJoined);
  }
  const auto goes_on = [&](std::size_t side, std::size_t part) {
    const Past past = sides[side].past[part];
    return past == Past::kPlane || past == Past::kTouch || is_cut_off[side];
  };
  bool is_alone = true;
  for (std::size_t i = 0; i < 4; ++i) {
    is_alone &= !is_cut_off[i] && sides[i].Count(Past::kPlane) + sides[i].Count(Past::kTouch) == 0;
  }
  if (is_alone) return beams;
  // What joins a side may reach into the rectangle, unless the side opposite tells where this one
  // is.
  std::array<double, 4> margin_m{};
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_told = sides[(i + 2) % 4].view == SideView::kMeasured;
    margin_m[i] = is_told ? kSideMarginM : (i % 2 == 1 ? model.width_m : model.height_m) / 4;
  }
  const auto tells = [&](const OutlineBeam& beam) {
    const Eigen::Vector2d q_m = places.ToRectangle(beam.position_m);
    const Eigen::Array2d outside_m = places.OutsideM(q_m);
    if (outside_m.minCoeff() > 0) {
      // Beyond a corner: at the ends of two sides.
      if (!beam.is_hit) return true;
      const std::size_t last = SideEvidence::kNumParts - 1;
      return !goes_on(q_m.x() > 0 ? 1 : 3, q_m.y() > 0 ? last : 0) &&
             !goes_on(q_m.y() > 0 ? 2 : 0, q_m.x() > 0 ? last : 0);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const auto place = places.At(q_m, i);
      if (place && place->outside_m > -margin_m[i] && goes_on(i, place->part)) return false;
    }
    return true;
  };
  std::vector<OutlineBeam> telling;
  telling.reserve(beams.size());
  std::copy_if(beams.begin(), beams.end(), std::back_inserter(telling), tells);
  return telling;
}

int NumMeasured(const std::array<SideEvidence, 4>& sides) {
  return static_cast<int>(std::count_if(sides.begin(), sides.end(), [](const auto& side) {
    return side.view == SideView::kMeasured;
  }));
}

}  // namespace voqcal
