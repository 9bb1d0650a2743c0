#include "core/lidar_detection/refusals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/lidar_detection/board_bend.hpp"
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

/// Of the hits from each other, in the mean.
double SpacingM(const Measurement& m) {
  const auto num = static_cast<double>(std::max(m.board_hits.size(), kMinBoardHits));
  return std::sqrt(m.model.width_m * m.model.height_m / num);
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

}  // namespace

std::optional<NoLidarBoard> OpenSide(const Measurement& m,
                                     const BeamIndex& beams,
                                     const std::array<OutlineEdge, 4>& edges,
                                     const Agreement& agreement,
                                     double slack) {
  constexpr double kMaxShortM = 0.05;   // hits of a closed outline come so near its edge...
  constexpr double kMaxSpacings = 1.5;  // ...or as near as the beams are to each other
  const double max_short_m = std::max(kMaxShortM, kMaxSpacings * SpacingM(m));
  const std::array<bool, 4> is_covered = CoveredPast(m, beams);
  const bool is_cropped = IsCropped(edges);
  const std::optional<std::size_t> edge =
      OpenEdge(edges,
               is_cropped ? std::array<bool, 4>{true, true, true, true} : is_covered,
               agreement,
               max_short_m,
               slack);
  if (!edge) return {};
  const LidarBoardMiss unhidden =
      is_covered[*edge] ? LidarBoardMiss::kGap : LidarBoardMiss::kCutOff;
  const bool is_hidden = IsHidden(m.view.BlockedM(), m.model, m.outline.pose, *edge);
  return NoLidarBoard{is_hidden ? LidarBoardMiss::kHidden : unhidden, SideOf(m, *edge)};
}

std::optional<NoLidarBoard> UnprovenSide(const Measurement& m) {
  constexpr double kNearM = 0.15;
  constexpr double kFarM = 0.4;  // scan lines may be so far apart
  constexpr int kMinBeams = 3;   // fewer are stray
  constexpr int kMinPartsShown = 2;
  const auto look = [&m](double past_m) {
    return LookPastEdges(m.view.Outline(), m.view.BlockedM(), m.model, m.outline.pose, past_m);
  };
  const std::array<PastEdge, 4> near = look(kNearM);
  const std::array<PastEdge, 4> far = look(kFarM);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_near_seen = near[i].num_misses + near[i].num_blocked > 0;
    const PastEdge& past = is_near_seen ? near[i] : far[i];
    if (past.num_blocked >= kMinBeams && past.num_blocked > past.num_misses &&
        past.num_parts_shown < kMinPartsShown) {
      return NoLidarBoard{LidarBoardMiss::kHidden, SideOf(m, i)};
    }
    if (!is_near_seen && 2 * past.num_parts_hit >= PastEdge::kNumParts) {
      return NoLidarBoard{LidarBoardMiss::kSizeMismatch, {}};
    }
  }
  return {};
}

bool HasRightSize(const Measurement& m,
                  const std::array<OutlineEdge, 4>& edges,
                  const std::array<double, 4>& measured_m,
                  const std::array<double, 4>& true_m) {
  // In halls full of crates and doors, of a thousand boards each way of scanning, looser limits
  // take more of these for the board, and tighter ones lose more boards (voqcal_figures
  // lidar-detection).
  constexpr LengthTolerance kOfOne{0.03, 4.0, 0.15};
  constexpr LengthTolerance kOfMean{0.03, 1.5, 0.08};
  if (!AreLengthsRight(measured_m, edges, true_m, kOfOne, kOfMean)) return false;
  // So sharp that no other size need be tried.
  constexpr LengthTolerance kSharpOfOne{0.03, 0.0, 0.03};
  constexpr LengthTolerance kSharpOfMean{0.02, 0.0, 0.02};
  if (AreLengthsRight(measured_m, edges, true_m, kSharpOfOne, kSharpOfMean)) return true;
  // Edge i and the one opposite reach from the edge before to the edge after. Without beams past
  // these the hits next to them would always favour a larger size.
  Eigen::Vector2d grows;
  for (std::size_t i = 0; i < 2; ++i) {
    const double error_m = measured_m[i] + measured_m[i + 2] - true_m[i] - true_m[i + 2];
    const bool may_grow = IsClosed(edges[(i + 3) % 4]) && IsClosed(edges[i + 1]);
    grows[static_cast<Eigen::Index>(i)] = error_m < 0 ? -1.0 : (may_grow ? 1.0 : 0.0);
  }
  return !HasRivalSize(m.view.Outline(), m.model, m.outline, grows);
}

std::optional<NoLidarBoard> Bend(const Measurement& m,
                                 const PointCloud& cloud_lidar_m,
                                 double max_bend_m) {
  constexpr double kCertain = 5.0;  // standard errors, themselves of a dozen scan lines
  const Eigen::Isometry3d T_board_lidar = TransformOf(m.frame, m.outline.pose).inverse();
  std::vector<Eigen::Vector3d> points_board_m = m.positions_m;
  for (Eigen::Vector3d& point_m : points_board_m) point_m = T_board_lidar * point_m;
  const BoardBend bend =
      MeasureBend(points_board_m, RingsOf(m, cloud_lidar_m), m.model.width_m, m.model.height_m);
  if (bend.bend_m - kCertain * bend.sigma_m <= max_bend_m) return {};
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
  return sigma_m > may_turn * max_sigma_m && HasTurnedRival(m.view.Outline(), m.model, m.outline);
}

}  // namespace voqcal
