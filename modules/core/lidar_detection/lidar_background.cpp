#include "core/lidar_detection/lidar_background.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/lidar_detection/lidar_beams.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

// About a degree: a board 8 m away covers 4 x 6 cells, and each has a beam of every sweep.
constexpr std::size_t kNumAzimuths = 360;
constexpr std::size_t kNumElevations = 128;
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// The sine of the elevation divides the sphere into bands of equal area.
std::size_t CellOf(const Eigen::Vector3f& position_m, double range_m) {
  const auto cut = [](double share, std::size_t num) {
    return std::min(static_cast<std::size_t>(share * static_cast<double>(num)), num - 1);
  };
  const std::size_t azimuth =
      cut(PseudoAzimuth(position_m.x(), position_m.y()) / 4.0, kNumAzimuths);
  const std::size_t elevation = cut((position_m.z() / range_m + 1.0) / 2.0, kNumElevations);
  return elevation * kNumAzimuths + azimuth;
}

/// Calls `visit(cell, range_m)` for each return.
template <typename Visit>
void ForEachReturn(const PointCloud& cloud_lidar_m, Visit visit) {
  for (const LidarPoint& point : cloud_lidar_m.points) {
    if (!IsReturn(point.position_m, 0.0)) continue;
    const double range_m = point.position_m.cast<double>().norm();
    visit(CellOf(point.position_m, range_m), static_cast<float>(range_m));
  }
}

}  // namespace

std::vector<std::string> LidarBackgroundOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("memory_sweeps", memory_sweeps);
  problems.RequirePositive("min_step_m", min_step_m);
  return problems.lines();
}

LidarBackground::LidarBackground(const LidarBackgroundOptions& options)
    : options_(options),
      cells_(kNumAzimuths * kNumElevations),
      nearest_m_(cells_.size(), kNothing) {
  RequireUsable("LidarBackground", options.Problems());
}

double LidarBackground::ShareThatCame(const PointCloud& points_lidar_m) const {
  const auto min_step_m = static_cast<float>(options_.min_step_m);
  double num = 0.0;
  double num_came = 0.0;
  ForEachReturn(points_lidar_m, [&](std::size_t i, float range_m) {
    num += 1;
    num_came += cells_[i].seen_in > 0 && cells_[i].range_m > range_m + min_step_m;
  });
  return num > 0 ? num_came / num : 0.0;
}

void LidarBackground::Learn(const PointCloud& sweep_lidar_m) {
  ++num_sweeps_;
  // The nearest of a cell's returns stands for it: those past the edge of a thing that stands in
  // part of the cell would make the thing itself look as if it had come.
  ForEachReturn(sweep_lidar_m, [&](std::size_t i, float range_m) {
    nearest_m_[i] = std::min(nearest_m_[i], range_m);
  });
  const auto min_step_m = static_cast<float>(options_.min_step_m);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (nearest_m_[i] == kNothing) continue;
    Cell& cell = cells_[i];
    const bool is_background = nearest_m_[i] > cell.range_m - min_step_m;
    const bool is_forgotten = num_sweeps_ - cell.seen_in > options_.memory_sweeps;
    if (is_background || is_forgotten) {
      // Noise must not carry it farther and farther.
      const bool is_new = is_forgotten || nearest_m_[i] > cell.range_m + min_step_m;
      cell = {is_new ? nearest_m_[i] : cell.range_m, num_sweeps_};
    }
    nearest_m_[i] = kNothing;
  }
}

}  // namespace voqcal
