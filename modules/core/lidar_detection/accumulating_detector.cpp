#include "core/lidar_detection/accumulating_detector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "core/geometry/rigid.hpp"
#include "core/lidar_detection/lidar_beams.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

// 0.13 to 0.26 degrees: what is nearer is mostly the same beam's footprint again.
constexpr std::size_t kNumAzimuths = 1800;
constexpr std::size_t kNumElevations = 573;
constexpr std::size_t kNumCells = kNumAzimuths * kNumElevations;
constexpr std::uint32_t kNoCell = kNumCells;  // of a point without a return

/// The direction's cell on the sphere, all being equally large.
std::uint32_t CellOf(const Eigen::Vector3f& position_m) {
  if (!IsReturn(position_m, 0.0)) return kNoCell;
  const Eigen::Vector3d p_m = position_m.cast<double>();
  const auto cut = [](double share, std::size_t num) {
    return std::min(static_cast<std::size_t>(share * static_cast<double>(num)), num - 1);
  };
  const std::size_t azimuth = cut(PseudoAzimuth(p_m.x(), p_m.y()) / 4.0, kNumAzimuths);
  const std::size_t elevation = cut((p_m.z() / p_m.norm() + 1.0) / 2.0, kNumElevations);
  return static_cast<std::uint32_t>(elevation * kNumAzimuths + azimuth);
}

/// A sweep that was sent twice.
bool IsSame(const PointCloud& a, const PointCloud& b) {
  const auto is_same = [](const LidarPoint& p, const LidarPoint& q) {
    return p.position_m == q.position_m;
  };
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), is_same);
}

std::vector<std::uint32_t> CellsOf(const PointCloud& cloud) {
  std::vector<std::uint32_t> cells;
  cells.reserve(cloud.points.size());
  for (const LidarPoint& point : cloud.points) cells.push_back(CellOf(point.position_m));
  return cells;
}

/// Cells that have a return.
class TakenCells {
 public:
  /// @return whether it was free.
  bool Take(std::uint32_t cell) {
    if (taken_[cell]) return false;
    taken_[cell] = true;
    return true;
  }
  /// There or in the next cell of the same elevation. A lidar that turns freely fires up to half a
  /// step aside each time, and its step is 0.4 degrees at 20 Hz.
  bool IsTakenNear(std::uint32_t cell) const {
    const std::size_t azimuth = cell % kNumAzimuths;
    const std::size_t row = cell - azimuth;
    return taken_[cell] || taken_[row + (azimuth + 1) % kNumAzimuths] ||
           taken_[row + (azimuth + kNumAzimuths - 1) % kNumAzimuths];
  }

 private:
  std::vector<bool> taken_ = std::vector<bool>(kNumCells + 1);
};

}  // namespace

AccumulatingDetector::AccumulatingDetector(const BoardSpec& board, const LidarBoardOptions& options)
    : board_(board), options_(options) {
  RequireUsable("AccumulatingDetector: board", board.Problems());
  RequireUsable("AccumulatingDetector: options", options.Problems());
}

LidarBoardSighting AccumulatingDetector::Detect(const PointCloud& sweep_lidar_m,
                                                std::int64_t utime,
                                                const LidarBackground* background) {
  LidarBoardSighting best{DetectLidarBoard(sweep_lidar_m, board_, options_, background)};
  Keep(sweep_lidar_m, utime);
  if (!is_repeating_) TellWhetherRepeating();
  const int num_sides = best.boards ? NumMeasuredSides(best.boards->front()) : -1;
  if (num_sides == 4 || is_repeating_.value_or(true)) return best;
  const std::size_t num = sweeps_.size();
  for (std::size_t first = 0; num - first >= 2; first += (num - first + 1) / 2) {
    const std::int64_t accumulated_us = utime - sweeps_[first].utime;
    auto found = DetectLidarBoard(Accumulated(first, num), board_, options_, background);
    if (!found) {
      const bool is_closer = !best.boards && found.error().miss > best.boards.error().miss;
      if (is_closer) best = {std::move(found), accumulated_us};
    } else if (NumMeasuredSides(found->front()) > num_sides && Rests(found->front(), first)) {
      return {std::move(found), accumulated_us};
    }
  }
  return best;
}

void AccumulatingDetector::Keep(const PointCloud& sweep_lidar_m, std::int64_t utime) {
  if (options_.max_accumulation_s == 0.0 || is_repeating_.value_or(false)) return;
  if (!sweeps_.empty() && utime <= sweeps_.back().utime) sweeps_.clear();
  sweeps_.push_back({utime, sweep_lidar_m, CellsOf(sweep_lidar_m)});
  const auto max_us = std::llround(options_.max_accumulation_s * 1e6);
  while (sweeps_.size() > 1 && utime - sweeps_.front().utime >= max_us) sweeps_.pop_front();
}

void AccumulatingDetector::TellWhetherRepeating() {
  constexpr std::size_t kTelling = 300;  // returns of a sweep
  constexpr double kMaxAgain = 0.8;      // of its directions, of a lidar that does not repeat them
  if (sweeps_.size() < 2) return;
  if (IsSame(sweeps_[sweeps_.size() - 2].cloud_lidar_m, sweeps_.back().cloud_lidar_m)) return;
  TakenCells before;
  for (const std::uint32_t cell : sweeps_[sweeps_.size() - 2].cells) before.Take(cell);
  std::size_t num = 0;
  std::size_t num_again = 0;
  for (const std::uint32_t cell : sweeps_.back().cells) {
    if (cell == kNoCell) continue;
    ++num;
    num_again += before.IsTakenNear(cell);
  }
  if (num < kTelling) return;
  is_repeating_ = static_cast<double>(num_again) > kMaxAgain * static_cast<double>(num);
  if (*is_repeating_) sweeps_.clear();
}

PointCloud AccumulatingDetector::Accumulated(std::size_t first, std::size_t last) const {
  const PointCloud& newest = sweeps_[last - 1].cloud_lidar_m;
  PointCloud all = newest;
  TakenCells taken;
  for (const std::uint32_t cell : sweeps_[last - 1].cells) taken.Take(cell);
  taken.Take(kNoCell);
  for (std::size_t i = last - 1; i-- > first;) {
    const PointCloud& cloud = sweeps_[i].cloud_lidar_m;
    if (cloud.has_ring != newest.has_ring || cloud.has_intensity != newest.has_intensity) continue;
    for (std::size_t k = 0; k < cloud.points.size(); ++k) {
      if (taken.Take(sweeps_[i].cells[k])) all.points.push_back(cloud.points[k]);
    }
  }
  return all;
}

bool AccumulatingDetector::Rests(const LidarBoard& found, std::size_t first) const {
  constexpr double kNearM = 0.1;
  constexpr double kNearRad = 0.17;
  constexpr double kChiSquare6 = 12.6;  // which one in twenty resting boards exceeds
  BoardPrior prior;
  prior.T_lidar_board = TransformFromPose(found.pose);
  prior.covariance.diagonal() << Eigen::Vector3d::Constant(kNearRad * kNearRad),
      Eigen::Vector3d::Constant(kNearM * kNearM);
  const std::size_t middle = first + (sweeps_.size() - first) / 2;
  const auto older = DetectLidarBoard(Accumulated(first, middle), board_, options_, nullptr, prior);
  const auto newer =
      DetectLidarBoard(Accumulated(middle, sweeps_.size()), board_, options_, nullptr, prior);
  if (!older || !newer) return false;
  const BoardPose& before = older->front().pose;
  const BoardPose& after = newer->front().pose;
  const Vector6d moved = DifferenceLeft(TransformFromPose(before), TransformFromPose(after));
  const Matrix6d covariance = before.covariance + after.covariance;
  return moved.dot(covariance.ldlt().solve(moved)) < kChiSquare6;
}

}  // namespace voqcal
