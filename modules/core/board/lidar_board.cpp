#include "core/board/lidar_board.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>

#include "core/board/board_candidate.hpp"
#include "core/board/lidar_beams.hpp"
#include "core/board/planar_patches.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinPoints = 30;  // a board with fewer returns cannot be measured

void RequireUsable(const char* what, const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text = std::string("DetectLidarBoard: ") + what;
  for (const std::string& problem : problems) text += "; " + problem;
  throw std::invalid_argument(text);
}

/// Where the board may be. Returns elsewhere still show where it ends.
std::vector<Eigen::Vector3d> SearchedPoints(const std::vector<LidarBeam>& beams,
                                            const LidarBoardOptions& options) {
  constexpr std::size_t kMaxPoints = 150000;  // bounds the time; patches need no more
  std::vector<Eigen::Vector3d> points_m;
  points_m.reserve(std::min(beams.size(), kMaxPoints));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const LidarBeam& beam = beams[i];
    if (!IsInShare(i, kMaxPoints, beams.size())) continue;
    if (beam.range_m > options.max_range_m) continue;
    const Eigen::Vector3d position_m = beam.PositionM();
    if (options.region_of_interest) {
      const RegionOfInterest& region = *options.region_of_interest;
      if ((position_m.array() < region.min_lidar_m.array()).any()) continue;
      if ((position_m.array() > region.max_lidar_m.array()).any()) continue;
    }
    points_m.push_back(position_m);
  }
  return points_m;
}

PatchSearchOptions PatchesOf(const BoardSpec& board) {
  PatchSearchOptions search;
  const double shorter_m = std::min(board.width_m, board.height_m);
  const double longer_m = std::max(board.width_m, board.height_m);
  search.voxel_m = shorter_m / 4;
  search.spread_m = Eigen::Vector2d(shorter_m, longer_m) / std::sqrt(12.0);  // of a full rectangle
  search.max_radius_m = std::hypot(shorter_m, longer_m);
  search.min_points = kMinPoints;
  return search;
}

/// Two patches can lead to the same board: the better one stands for it.
bool OverlapsAny(const LidarBoard& board, const std::vector<LidarBoard>& better, double size_m) {
  return std::any_of(better.begin(), better.end(), [&](const LidarBoard& other) {
    return (other.pose.centre_m - board.pose.centre_m).norm() < size_m;
  });
}

/// Best first, each place once.
std::vector<LidarBoard> Ranked(std::vector<LidarBoard> found, const BoardSpec& board) {
  std::stable_sort(found.begin(), found.end(), [](const LidarBoard& a, const LidarBoard& b) {
    return a.log_likelihood > b.log_likelihood;
  });
  std::vector<LidarBoard> ranked;
  for (LidarBoard& candidate : found) {
    if (OverlapsAny(candidate, ranked, std::min(board.width_m, board.height_m))) continue;
    ranked.push_back(std::move(candidate));
  }
  return ranked;
}

}  // namespace

std::vector<std::string> LidarBoardOptions::Problems() const {
  std::vector<std::string> problems;
  const auto require = [&problems](bool is_met, const std::string& rule, double value) {
    if (is_met) return;
    std::ostringstream text;
    text << rule << ", is " << value;
    problems.push_back(text.str());
  };
  require(min_range_m >= 0, "min_range_m must not be negative", min_range_m);
  require(max_range_m > min_range_m && std::isfinite(max_range_m),
          "max_range_m must be finite and above min_range_m",
          max_range_m);
  if (!region_of_interest) return problems;
  for (int axis = 0; axis < 3; ++axis) {
    require(region_of_interest->max_lidar_m[axis] > region_of_interest->min_lidar_m[axis],
            std::string("region_of_interest max must be above min on axis ") + "xyz"[axis],
            region_of_interest -> max_lidar_m[axis]);
  }
  return problems;
}

std::string ToString(LidarBoardMiss miss) {
  switch (miss) {
    case LidarBoardMiss::kTooFewPoints:
      return "too few points";
    case LidarBoardMiss::kNoPlane:
      return "no plane of the board's size";
    case LidarBoardMiss::kSizeMismatch:
      return "size mismatch";
    case LidarBoardMiss::kOutlineOpen:
      return "outline open";
    case LidarBoardMiss::kAmbiguous:
      return "ambiguous";
  }
  throw std::logic_error("ToString: unknown LidarBoardMiss");
}

Expected<std::vector<LidarBoard>, LidarBoardMiss> DetectLidarBoard(
    const PointCloud& cloud_lidar_m, const BoardSpec& board, const LidarBoardOptions& options) {
  constexpr std::size_t kMaxPatches = 12;  // bounds the time; a room has two or three
  constexpr double kAsGood = 0.8;          // share of the best likelihood that a rival may reach
  RequireUsable("board", board.Problems());
  RequireUsable("options", options.Problems());

  const std::vector<LidarBeam> beams = ValidBeams(cloud_lidar_m, options.min_range_m);
  const std::vector<Eigen::Vector3d> points_m = SearchedPoints(beams, options);
  if (points_m.size() < kMinPoints) return LidarBoardMiss::kTooFewPoints;

  std::vector<PlanarPatch> patches = FindPlanarPatches(points_m, PatchesOf(board));
  if (patches.size() > kMaxPatches) patches.resize(kMaxPatches);
  const BeamIndex index(beams);
  std::vector<LidarBoard> found;
  LidarBoardMiss miss = LidarBoardMiss::kNoPlane;  // of the patch that came closest
  for (const PlanarPatch& patch : patches) {
    auto measured = MeasureBoard(patch, index, cloud_lidar_m, board);
    if (measured)
      found.push_back(std::move(*measured));
    else
      miss = std::max(miss, measured.error());
  }
  if (found.empty()) return miss;

  std::vector<LidarBoard> ranked = Ranked(std::move(found), board);
  if (ranked.size() > 1 && ranked[1].log_likelihood > kAsGood * ranked[0].log_likelihood) {
    return LidarBoardMiss::kAmbiguous;
  }
  return ranked;
}

}  // namespace voqcal
