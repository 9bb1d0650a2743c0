#include "core/lidar_detection/refusals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/lidar_detection/board_bend.hpp"
#include "core/lidar_detection/detection_tolerances.hpp"
#include "core/lidar_detection/outline_doubt.hpp"

namespace voqcal {
namespace {

/// "on the upper left": where `direction_lidar` points in the view of a lidar that looks along
/// `ray`.
std::string SideInView(const Eigen::Vector3d& direction_lidar, const Eigen::Vector3d& ray) {
  constexpr double kEighth = 0.78539816339744831;  // of a turn
  static constexpr std::array<const char*, 8> kNames = {"on the left",
                                                        "on the upper left",
                                                        "at the top",
                                                        "on the upper right",
                                                        "on the right",
                                                        "on the lower right",
                                                        "at the bottom",
                                                        "on the lower left"};
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(ray);
  const Eigen::Vector3d up = ray.cross(left);
  const double angle_rad = std::atan2(direction_lidar.dot(up), direction_lidar.dot(left));
  return kNames[static_cast<std::size_t>(std::lround(angle_rad / kEighth) + 8) % 8];
}

/// Whether the sensor looks past each edge, as far as a few beams need.
std::array<bool, 4> CoveredPast(const Measurement& m, const BeamIndex& beams) {
  const double past_edge_m = std::clamp(2 * SpacingM(m), 0.03, 0.1);
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  const Eigen::Vector2d half_m(m.model.width_m / 2, m.model.height_m / 2);
  std::array<bool, 4> is_covered{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d outward = OutwardOf(i);
    const Eigen::Vector2d past_m = outward.cwiseProduct(half_m) + past_edge_m * outward;
    is_covered[i] = beams.Covers(T_lidar_board * Eigen::Vector3d(past_m.x(), past_m.y(), 0.0));
  }
  return is_covered;
}

/// A cloud that was cropped to the board shows hardly anything past any edge: then its hits alone
/// must do.
bool IsCropped(const std::array<OutlineEdge, 4>& edges) {
  constexpr int kFewMisses = 4;  // for each of so many hits
  return std::all_of(edges.begin(), edges.end(), [](const OutlineEdge& edge) {
    return kFewMisses * edge.num_misses <= edge.num_hits;  // both 0 between scan lines
  });
}

/// "on the left", seen from the lidar: where an edge of the rectangle is.
std::string SideOf(const Measurement& m, std::size_t edge) {
  const Eigen::Isometry3d T_lidar_board = TransformOf(m.frame, m.outline.pose);
  const Eigen::Vector2d outward = OutwardOf(edge);
  const Eigen::Vector3d outward_lidar =
      T_lidar_board.linear() * Eigen::Vector3d(outward.x(), outward.y(), 0.0);
  return SideInView(outward_lidar, T_lidar_board.translation());
}

/// " (the ground)" where that is likely.
std::string JoinedTo(const Measurement& m, std::size_t side) {
  constexpr double kDown = -0.8;
  const Eigen::Vector2d outward = OutwardOf(side);
  const double up = TransformOf(m.frame, m.outline.pose).linear().row(2).head<2>().dot(outward);
  const SideEvidence& at = m.sides[side];
  const bool is_ground =
      up < kDown && at.Count(SideEvidence::Past::kTouch) > at.Count(SideEvidence::Past::kPlane);
  return is_ground ? " (the ground)" : "";
}

NoLidarBoard OpenAt(const Measurement& m, std::size_t side) {
  switch (m.sides[side].view) {
    case SideView::kJoined:
      return {LidarBoardMiss::kJoined, SideOf(m, side) + JoinedTo(m, side)};
    case SideView::kHidden:
      return {LidarBoardMiss::kHidden, SideOf(m, side)};
    case SideView::kCutOff:
      return {LidarBoardMiss::kCutOff, SideOf(m, side)};
    case SideView::kMeasured:
    case SideView::kGap:
      break;
  }
  return {LidarBoardMiss::kGap, SideOf(m, side)};
}

/// Of one side's eight, whatever was concluded from the others.
int NumPartsOnPlane(const Measurement& m, std::size_t side) {
  return LookAtSides(m.view.Outline(), m.view.Blocked(), m.model, m.outline.pose, SpacingM(m))[side]
      .Count(SideEvidence::Past::kPlane);
}

/// The side that hits come up to least.
std::size_t LeastReached(const Measurement& m) {
  const auto least = std::min_element(
      m.sides.begin(), m.sides.end(), [](const SideEvidence& a, const SideEvidence& b) {
        return a.reach_m < b.reach_m;
      });
  return static_cast<std::size_t>(least - m.sides.begin());
}

}  // namespace

std::array<bool, 4> ToldSides(const Measurement& m,
                              const BeamIndex& beams,
                              const std::array<OutlineEdge, 4>& edges) {
  const bool is_cropped = IsCropped(edges);
  const std::array<bool, 4> is_covered = CoveredPast(m, beams);
  const double max_short_m = std::max(kMaxShortM, kMaxShortSpacings * SpacingM(m));
  constexpr double kMaxToldSigmaM = 0.1;  // beyond, no beam is left past it, only what joins it
  std::array<bool, 4> is_told{};
  for (std::size_t i = 0; i < 4; ++i) {
    const SideEvidence& side = m.sides[i];
    const bool is_joined = side.Count(SideEvidence::Past::kPlane) > 0;
    const bool is_measured = side.view == SideView::kMeasured &&
                             !(is_joined && edges[i].offset_sigma_m > kMaxToldSigmaM);
    const bool is_last_seen = side.view == SideView::kCutOff && -side.reach_m < max_short_m;
    is_told[i] = is_measured || (is_last_seen && (is_cropped || is_covered[i]));
  }
  return is_told;
}

bool HasRightSize(const Measurement& m,
                  const std::array<OutlineEdge, 4>& edges,
                  const std::array<double, 4>& measured_m,
                  const std::array<double, 4>& true_m,
                  const std::array<bool, 4>& is_told) {
  const bool is_whole = std::all_of(is_told.begin(), is_told.end(), [](bool told) { return told; });
  const LengthTolerance& of_one = is_whole ? kLengthOfOne : kPairOfOne;
  const LengthTolerance& of_mean = is_whole ? kLengthOfMean : kPairOfMean;
  if (!AreLengthsRight(measured_m, edges, true_m, is_told, of_one, of_mean)) return false;
  if (!is_whole) return true;  // one pair cannot tell another size from a spill
  // So sharp that no other size need be tried.
  constexpr LengthTolerance kSharpOfOne{0.03, 0.0, 0.03};
  constexpr LengthTolerance kSharpOfMean{0.02, 0.0, 0.02};
  if (AreLengthsRight(measured_m, edges, true_m, is_told, kSharpOfOne, kSharpOfMean)) return true;
  // Edge i and the one opposite reach from the edge before to the edge after. Without beams past
  // these the hits next to them would always favour a larger size.
  Eigen::Vector2d grows;
  for (std::size_t i = 0; i < 2; ++i) {
    const SideView before = m.sides[(i + 3) % 4].view;
    const SideView after = m.sides[i + 1].view;
    const double error_m = measured_m[i] + measured_m[i + 2] - true_m[i] - true_m[i + 2];
    const bool may_grow = before == SideView::kMeasured && after == SideView::kMeasured;
    grows[static_cast<Eigen::Index>(i)] = error_m < 0 ? -1.0 : (may_grow ? 1.0 : 0.0);
  }
  return !HasRivalSize(m.telling, m.model, m.outline, grows);
}

std::optional<NoLidarBoard> Doubt(const Measurement& m,
                                  const Agreement& agreement,
                                  const std::array<bool, 4>& is_told) {
  const auto num_told = std::count(is_told.begin(), is_told.end(), true);
  const auto open =
      static_cast<std::size_t>(std::find(is_told.begin(), is_told.end(), false) - is_told.begin());
  if (num_told == 4) {
    // Gaps of the scan are no holes, if hits and misses show all of the outline.
    const bool is_outlined =
        NumMeasured(m.sides) == 4 && m.sides[LeastReached(m)].reach_m > -kMaxShortM / 2;
    const bool has_holes = agreement.empty > 1.0 - kMinCovered;
    if (agreement.covered >= kMinCovered || (is_outlined && !has_holes)) return {};
    return OpenAt(m, LeastReached(m));
  }
  if (num_told < 3 || m.board_hits.size() < kMinHitsOfThree) return OpenAt(m, open);
  // A strip of the board's width may be anything.
  constexpr int kMaxPartsJoined = 5;
  const bool is_strip = NumPartsOnPlane(m, open) > kMaxPartsJoined;
  const bool may_go_on = m.sides[open].view == SideView::kCutOff;
  if (is_strip || may_go_on || agreement.covered < kMinCoveredOfThree) return OpenAt(m, open);
  return {};
}

std::optional<NoLidarBoard> Bend(const Measurement& m,
                                 const PointCloud& cloud_lidar_m,
                                 double max_bend_m) {
  constexpr double kCertain = 5.0;        // standard errors, themselves of a dozen scan lines
  constexpr double kMostOfABoardM = 0.1;  // what is bent more is none
  const Eigen::Isometry3d T_board_lidar = TransformOf(m.frame, m.outline.pose).inverse();
  std::vector<Eigen::Vector3d> points_board_m = m.positions_m;
  for (Eigen::Vector3d& point_m : points_board_m) point_m = T_board_lidar * point_m;
  const BoardBend bend =
      MeasureBend(points_board_m, RingsOf(m, cloud_lidar_m), m.model.width_m, m.model.height_m);
  if (bend.bend_m - kCertain * bend.sigma_m <= max_bend_m) return {};
  if (bend.bend_m > kMostOfABoardM) return NoLidarBoard{LidarBoardMiss::kNoPlane, {}};
  std::ostringstream detail;
  detail << "by " << std::lround(bend.bend_m * 1e3) << " mm";
  return NoLidarBoard{LidarBoardMiss::kBent, detail.str()};
}

bool IsLoose(const Measurement& m, double max_sigma_m) {
  // Shares of the largest sigma: with less, no board was ever found turned, with many hits and with
  // few.
  constexpr double kMayTurn = 0.25;
  constexpr double kMayTurnIfFew = 0.15;
  constexpr std::size_t kFewHits = 150;
  const double sigma_m = CornerSigmaM(m.outline, m.model);
  if (sigma_m > max_sigma_m) return true;
  const double may_turn = m.board_hits.size() < kFewHits ? kMayTurnIfFew : kMayTurn;
  return sigma_m > may_turn * max_sigma_m && HasTurnedRival(m.telling, m.model, m.outline);
}

}  // namespace voqcal
