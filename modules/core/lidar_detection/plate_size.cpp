#include "core/lidar_detection/plate_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr double kStepM = 0.06;  // half of it is what the detector lets a length be off, at least
constexpr double kMaxMarginM = 0.6;       // of a plate around its pattern, both sides together
constexpr std::size_t kNumSearched = 12;  // sweeps; the best sizes are then looked for in all
constexpr int kLeastPlaces = 3;

struct Sightings {
  std::vector<Eigen::Vector3d> centres_m;  // a place each
  std::vector<double> longer_m;
  std::vector<double> shorter_m;
};

/// The pattern counts for nothing: the plate may stand on either edge.
BoardSpec OfSize(double longer_m, double shorter_m) {
  BoardSpec board;
  board.width_m = longer_m;
  board.height_m = shorter_m;
  board.square_m = 0.01;
  board.num_corners_x = board.num_corners_y = 3;
  return board;
}

void AddIfNewPlace(const LidarBoard& board, Sightings* sightings) {
  constexpr double kApartM = 0.1;
  if (NumMeasuredSides(board) < 4) return;
  for (const Eigen::Vector3d& centre_m : sightings->centres_m) {
    if ((centre_m - board.pose.centre_m).norm() < kApartM) return;
  }
  sightings->centres_m.push_back(board.pose.centre_m);
  const std::array<double, 4>& lengths_m = board.edge_lengths_m;
  sightings->longer_m.push_back((lengths_m[0] + lengths_m[2]) / 2);
  sightings->shorter_m.push_back((lengths_m[1] + lengths_m[3]) / 2);
}

/// Of every `step`-th sweep.
Sightings See(const std::vector<PointCloud>& sweeps_lidar_m,
              std::size_t step,
              const BoardSpec& board,
              const LidarBoardOptions& options) {
  Sightings sightings;
  for (std::size_t i = 0; i < sweeps_lidar_m.size(); i += step) {
    const auto found = DetectLidarBoard(sweeps_lidar_m[i], board, options);
    if (!found) continue;
    for (const LidarBoard& each : *found) AddIfNewPlace(each, &sightings);
  }
  return sightings;
}

double SpreadM(const std::vector<double>& values_m, double middle_m) {
  std::vector<double> off_m;
  for (const double value_m : values_m) off_m.push_back(std::abs(value_m - middle_m));
  constexpr double kMedianToSigma = 1.4826;  // of a normal distribution
  return kMedianToSigma * Median(off_m) / std::sqrt(static_cast<double>(values_m.size()));
}

/// What is measured where a board like `board` is found. Lengths are as uncertain as the spill past
/// either end, which all sweeps share.
PlateSize Measure(const std::vector<PointCloud>& sweeps_lidar_m,
                  std::size_t step,
                  const BoardSpec& board,
                  const LidarBoardOptions& options) {
  const Sightings sightings = See(sweeps_lidar_m, step, board, options);
  if (sightings.centres_m.empty()) return {};
  const double longer_m = Median(sightings.longer_m);
  const double shorter_m = Median(sightings.shorter_m);
  const double spread_m =
      std::max(SpreadM(sightings.longer_m, longer_m), SpreadM(sightings.shorter_m, shorter_m));
  return {std::max(longer_m, shorter_m),
          std::min(longer_m, shorter_m),
          std::hypot(spread_m, 2 * options.beam.spill_sigma_m),
          static_cast<int>(sightings.centres_m.size())};
}

void SortByPlaces(std::vector<PlateSize>* sizes) {
  std::stable_sort(sizes->begin(), sizes->end(), [](const PlateSize& a, const PlateSize& b) {
    return a.num_places > b.num_places;
  });
}

/// Every size on a grid, as measured; the most often found first.
std::vector<PlateSize> SearchSizes(const std::vector<PointCloud>& sweeps_lidar_m,
                                   const BoardSpec& pattern,
                                   const LidarBoardOptions& options,
                                   const std::function<void(double)>& on_progress) {
  const Eigen::Vector2d least_m = pattern.LeastPlateM();
  const std::size_t step = 1 + (sweeps_lidar_m.size() - 1) / kNumSearched;
  const auto num_steps = static_cast<int>(kMaxMarginM / kStepM);
  std::vector<PlateSize> sizes;
  for (int i = 0; i <= num_steps; ++i) {
    if (on_progress) on_progress(static_cast<double>(i) / num_steps);
    for (int j = 0; j <= num_steps; ++j) {
      const double longer_m = least_m.maxCoeff() + i * kStepM;
      const double shorter_m = least_m.minCoeff() + j * kStepM;
      if (shorter_m > longer_m) break;
      sizes.push_back(Measure(sweeps_lidar_m, step, OfSize(longer_m, shorter_m), options));
    }
  }
  SortByPlaces(&sizes);
  return sizes;
}

bool IsSameSize(const PlateSize& a, const PlateSize& b) {
  return std::hypot(a.longer_m - b.longer_m, a.shorter_m - b.shorter_m) < kStepM;
}

/// Looks for what was measured instead, in all sweeps.
PlateSize Settle(const std::vector<PointCloud>& sweeps_lidar_m,
                 const LidarBoardOptions& options,
                 PlateSize size) {
  constexpr int kRounds = 2;
  for (int i = 0; i < kRounds && size.num_places > 0; ++i) {
    size = Measure(sweeps_lidar_m, 1, OfSize(size.longer_m, size.shorter_m), options);
  }
  return size;
}

}  // namespace

std::optional<PlateSize> MeasurePlateSize(const std::vector<PointCloud>& sweeps_lidar_m,
                                          const BoardSpec& pattern,
                                          const LidarBoardOptions& options,
                                          const std::function<void(double)>& on_progress) {
  constexpr std::size_t kNumSettled = 6;
  if (sweeps_lidar_m.empty()) return {};
  std::vector<PlateSize> searched = SearchSizes(sweeps_lidar_m, pattern, options, on_progress);
  searched.resize(std::min(kNumSettled, searched.size()));
  std::vector<PlateSize> sizes;
  for (const PlateSize& each : searched) {
    const PlateSize size = Settle(sweeps_lidar_m, options, each);
    const auto same = std::find_if(
        sizes.begin(), sizes.end(), [&size](const PlateSize& s) { return IsSameSize(s, size); });
    if (same == sizes.end()) {
      sizes.push_back(size);
    } else if (size.num_places > same->num_places) {
      *same = size;
    }
  }
  SortByPlaces(&sizes);
  const bool is_clear = sizes.size() < 2 || sizes[0].num_places > sizes[1].num_places;
  if (sizes[0].num_places < kLeastPlaces || !is_clear) return {};
  return sizes[0];
}

}  // namespace voqcal
