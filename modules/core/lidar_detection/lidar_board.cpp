#include "core/lidar_detection/lidar_board.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/lidar/scan_lines.hpp"
#include "core/lidar_detection/cloud_axes.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/measure_board.hpp"
#include "core/lidar_detection/planar_patches.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

constexpr double kPartM = 0.1;          // so near its plane a patch is of the same board
constexpr std::size_t kMinPoints = 30;  // a board with fewer returns cannot be measured

bool IsSearched(const Eigen::Vector3f& position_m, const LidarBoardOptions& options) {
  if (!IsReturn(position_m, options.min_range_m)) return false;
  const Eigen::Vector3d p_m = position_m.cast<double>();
  if (p_m.squaredNorm() > options.max_range_m * options.max_range_m) return false;
  if (!options.region_of_interest) return true;
  const RegionOfInterest& region = *options.region_of_interest;
  return (p_m.array() >= region.min_lidar_m.array()).all() &&
         (p_m.array() <= region.max_lidar_m.array()).all();
}

/// Where the board may be. Returns elsewhere still show where it ends.
std::vector<Eigen::Vector3d> SearchedPoints(const PointCloud& cloud_lidar_m,
                                            const LidarBoardOptions& options) {
  constexpr std::size_t kMaxPoints = 60000;  // bounds the time; patches need no more
  const std::vector<LidarPoint>& points = cloud_lidar_m.points;
  std::vector<Eigen::Vector3d> points_m;
  points_m.reserve(std::min(points.size(), kMaxPoints + kMaxPoints / 8));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!IsInShare(i, kMaxPoints, points.size())) continue;
    if (!IsSearched(points[i].position_m, options)) continue;
    points_m.push_back(points[i].position_m.cast<double>());
  }
  return points_m;
}

PatchSearchOptions PatchesOf(const BoardSpec& board) {
  PatchSearchOptions search;
  const double shorter_m = std::min(board.width_m, board.height_m);
  const double longer_m = std::max(board.width_m, board.height_m);
  search.voxel_m = shorter_m / 4;
  search.spread_m = Eigen::Vector2d(shorter_m, longer_m) / std::sqrt(12.0);  // of a full rectangle
  search.max_radius_m = std::hypot(shorter_m, longer_m) / 2 + search.voxel_m;
  search.min_points = kMinPoints;
  return search;
}

/// The same cloud with the rings that its geometry tells, if it has none or names other things so;
/// nothing if it may stay as it is.
std::optional<PointCloud> Ringed(const PointCloud& cloud_lidar_m) {
  if (cloud_lidar_m.has_ring && AreRingsScanLines(cloud_lidar_m)) return {};
  const std::vector<std::uint16_t> lines = ScanLinesOf(cloud_lidar_m);
  if (lines.empty() && !cloud_lidar_m.has_ring) return {};
  PointCloud ringed = cloud_lidar_m;
  ringed.has_ring = !lines.empty();
  for (std::size_t i = 0; i < lines.size(); ++i) ringed.points[i].ring = lines[i];
  return ringed;
}

/// The patches of the points, searched in the cloud's own axes.
std::vector<PlanarPatch> PatchesInAxes(std::vector<Eigen::Vector3d> points_m,
                                       const Eigen::Matrix3d& R_axes_lidar,
                                       const BoardSpec& board) {
  for (Eigen::Vector3d& point_m : points_m) point_m = R_axes_lidar * point_m;
  std::vector<PlanarPatch> patches = FindPlanarPatches(points_m, PatchesOf(board));
  const Eigen::Matrix3d R_lidar_axes = R_axes_lidar.transpose();
  for (PlanarPatch& patch : patches) {
    patch.middle_m = R_lidar_axes * patch.middle_m;
    patch.plane.point_m = R_lidar_axes * patch.plane.point_m;
    patch.plane.normal = R_lidar_axes * patch.plane.normal;
  }
  return patches;
}

/// A board may fall into several patches.
bool IsPartOfAny(const PlanarPatch& patch, const std::vector<LidarBoard>& found) {
  return std::any_of(found.begin(), found.end(), [&](const LidarBoard& board) {
    const Eigen::Vector3d offset_m = patch.middle_m - board.pose.centre_m;
    const Eigen::Vector3d width_m = board.pose.corners_m[1] - board.pose.corners_m[0];
    const Eigen::Vector3d height_m = board.pose.corners_m[3] - board.pose.corners_m[0];
    return std::abs(offset_m.dot(board.pose.normal)) < kPartM &&
           std::abs(offset_m.dot(width_m)) < width_m.squaredNorm() / 2 &&
           std::abs(offset_m.dot(height_m)) < height_m.squaredNorm() / 2;
  });
}

/// What came since the background was learned is up to twice as likely.
void Favour(const LidarBackground& background, std::vector<LidarBoard>* found) {
  for (LidarBoard& board : *found) {
    board.log_likelihood +=
        background.ShareThatCame(board.points_lidar_m) * std::abs(board.log_likelihood);
  }
}

/// Two patches can lead to the same board: the better one stands for it.
bool OverlapsAny(const LidarBoard& board, const std::vector<LidarBoard>& better, double size_m) {
  return std::any_of(better.begin(), better.end(), [&](const LidarBoard& other) {
    return (other.pose.centre_m - board.pose.centre_m).norm() < size_m;
  });
}

/// Whether a rival is nearly as likely as the best, in nats; a whole sighting beats a partial one.
bool IsAsGood(const LidarBoard& rival, const LidarBoard& best) {
  constexpr double kLess = 0.2;  // of the best one's evidence...
  constexpr double kNats = 5.0;  // ...or a likelihood ratio of 150
  return NumMeasuredSides(rival) >= NumMeasuredSides(best) &&
         best.log_likelihood - rival.log_likelihood <
             std::max(kLess * std::abs(best.log_likelihood), kNats);
}

/// Best first, each place once.
std::vector<LidarBoard> Ranked(std::vector<LidarBoard> found, const BoardSpec& board) {
  std::stable_sort(found.begin(), found.end(), [](const LidarBoard& a, const LidarBoard& b) {
    const bool is_a_whole = NumMeasuredSides(a) == 4;
    const bool is_b_whole = NumMeasuredSides(b) == 4;
    return is_a_whole != is_b_whole ? is_a_whole : a.log_likelihood > b.log_likelihood;
  });
  std::vector<LidarBoard> ranked;
  for (LidarBoard& candidate : found) {
    if (OverlapsAny(candidate, ranked, std::min(board.width_m, board.height_m))) continue;
    ranked.push_back(std::move(candidate));
  }
  return ranked;
}

/// What the patches of a sweep may be.
struct Search {
  std::vector<LidarBoard> sure;
  std::vector<LidarBoard> unsure;
  NoLidarBoard closest{LidarBoardMiss::kNoPlane, {}};
};

Search SearchPatches(const std::vector<Eigen::Vector3d>& points_m,
                     const BeamIndex& index,
                     const PointCloud& cloud_lidar_m,
                     const BoardSpec& board,
                     const LidarBoardOptions& options) {
  // Bounds on the time: patches come in the order of how like the board they are spread.
  constexpr std::size_t kMaxPatches = 8;
  constexpr std::size_t kMaxPatchesUntilFound = 40;
  const std::vector<PlanarPatch> patches = PatchesInAxes(points_m, index.R_axes_lidar(), board);
  Search search;
  const auto come_closer = [&search](NoLidarBoard none) {
    if (none.miss > search.closest.miss) search.closest = std::move(none);
  };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (i >= (search.sure.empty() ? kMaxPatchesUntilFound : kMaxPatches)) break;
    if (IsPartOfAny(patches[i], search.sure)) continue;
    auto measured = MeasureBoard(patches[i], index, cloud_lidar_m, board, options);
    if (!measured) {
      come_closer(measured.error());
    } else if (measured->doubt) {
      search.unsure.push_back(std::move(measured->board));
      come_closer(std::move(*measured->doubt));
    } else {
      search.sure.push_back(std::move(measured->board));
    }
  }
  return search;
}

}  // namespace

std::vector<std::string> LidarBeamOptions::Problems() const {
  ProblemList problems;
  problems.Require(spill_m >= 0, "spill_m must not be negative", spill_m);
  problems.RequirePositive("spill_sigma_m", spill_sigma_m);
  problems.RequirePositive("blur_m", blur_m);
  problems.Require(blur_per_m >= 0, "blur_per_m must not be negative", blur_per_m);
  problems.RequirePositive("hit_band_m", hit_band_m);
  problems.Require(line_sigma_m >= 0, "line_sigma_m must not be negative", line_sigma_m);
  return problems.lines();
}

std::vector<std::string> LidarBoardOptions::Problems() const {
  ProblemList problems;
  problems.Require(min_range_m >= 0, "min_range_m must not be negative", min_range_m);
  problems.Require(max_range_m > min_range_m && std::isfinite(max_range_m),
                   "max_range_m must be finite and above min_range_m",
                   max_range_m);
  problems.RequirePositive("max_corner_sigma_m", max_corner_sigma_m);
  problems.RequirePositive("max_bend_m", max_bend_m);
  problems.Require(thickness_m >= 0, "thickness_m must not be negative", thickness_m);
  problems.RequirePositive("thickness_sigma_m", thickness_sigma_m);
  problems.Require(max_accumulation_s >= 0 && max_accumulation_s <= 10,
                   "max_accumulation_s must be from 0 to 10",
                   max_accumulation_s);
  problems.Add(beam.Problems(), "beam: ");
  problems.Add(background.Problems(), "background: ");
  if (!region_of_interest) return problems.lines();
  for (int axis = 0; axis < 3; ++axis) {
    problems.Require(region_of_interest->max_lidar_m[axis] > region_of_interest->min_lidar_m[axis],
                     std::string("region_of_interest max must be above min on axis ") + "xyz"[axis],
                     region_of_interest -> max_lidar_m[axis]);
  }
  return problems.lines();
}

std::vector<std::string> BoardPrior::Problems() const {
  ProblemList problems;
  for (Eigen::Index i = 0; i < 6; ++i) {
    problems.RequirePositive("covariance(" + std::to_string(i) + ", " + std::to_string(i) + ")",
                             covariance(i, i));
  }
  problems.Require(T_lidar_board.matrix().allFinite(),
                   "T_lidar_board must be finite",
                   T_lidar_board.translation().transpose());
  return problems.lines();
}

Expected<std::vector<LidarBoard>, NoLidarBoard> DetectLidarBoard(
    const PointCloud& sweep_lidar_m,
    const BoardSpec& board,
    const LidarBoardOptions& options,
    const LidarBackground* background,
    const std::optional<BoardPrior>& prior) {
  RequireUsable("DetectLidarBoard: board", board.Problems());
  RequireUsable("DetectLidarBoard: options", options.Problems());
  if (prior) RequireUsable("DetectLidarBoard: prior", prior->Problems());

  const std::optional<PointCloud> ringed = Ringed(sweep_lidar_m);
  const PointCloud& cloud_lidar_m = ringed ? *ringed : sweep_lidar_m;
  const std::vector<Eigen::Vector3d> points_m = SearchedPoints(cloud_lidar_m, options);
  if (points_m.size() < kMinPoints) return NoLidarBoard{LidarBoardMiss::kTooFewPoints, {}};

  const BeamIndex index(cloud_lidar_m, options.min_range_m, CloudAxes(points_m));
  if (prior) {
    auto measured = MeasureExpectedBoard(*prior, index, cloud_lidar_m, board, options);
    if (!measured) return measured.error();
    return std::vector<LidarBoard>{std::move(measured->board)};
  }
  Search search = SearchPatches(points_m, index, cloud_lidar_m, board, options);
  if (background != nullptr) Favour(*background, &search.sure);
  if (background != nullptr) Favour(*background, &search.unsure);
  std::vector<LidarBoard> sure = Ranked(std::move(search.sure), board);
  NoLidarBoard none = std::move(search.closest);
  if (sure.size() > 1 && IsAsGood(sure[1], sure[0])) {
    none = {LidarBoardMiss::kAmbiguous, {}};
    std::move(sure.begin(), sure.end(), std::back_inserter(search.unsure));
  } else if (!sure.empty()) {
    return sure;
  }
  none.unsure = Ranked(std::move(search.unsure), board);
  return none;
}

}  // namespace voqcal
