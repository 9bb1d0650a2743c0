#include "core/simulation/guided_board.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/rigid.hpp"
#include "core/simulation/board_path.hpp"
#include "core/simulation/keyed_noise.hpp"

namespace voqcal {
namespace {

constexpr double kPatienceS = 5.0;
// How far people are off, RMS: `voqcal_figures guidance` has the same.
constexpr double kPlaceErrorM = 0.2;
constexpr double kTurnErrorRad = 10.0 * M_PI / 180.0;
constexpr int kNumTrials = 200;

}  // namespace

Eigen::Isometry3d PoseAt(double time_s,
                         const std::vector<BoardStop>& stops,
                         const SimulationOptions& options) {
  const auto is_left = [time_s](const BoardStop& stop) { return stop.leave_s <= time_s; };
  const auto next = std::find_if_not(stops.begin() + 1, stops.end(), is_left);
  const BoardStop& to = *(next - 1);
  if (next - 1 == stops.begin() || time_s >= to.leave_s + options.move_s) return to.T_lidar_board;
  const double forward_azimuth_rad = ForwardAzimuthRad(options.T_camera_lidar);
  const auto place = [&](const BoardStop& stop) {
    return Unwound(PlaceOf(stop.T_lidar_board), forward_azimuth_rad);
  };
  return PoseOf(Between(place(*(next - 2)), place(to), (time_s - to.leave_s) / options.move_s));
}

GuidedBoard::GuidedBoard(const SimulationOptions& options, const Simulation& simulation)
    : options_(options), simulation_(simulation), stops_({{0.0, simulation.T_lidar_board(0.0)}}) {}

void GuidedBoard::Ask(std::int64_t request, const Eigen::Isometry3d& T_camera_board) {
  if (request_ == request) return;
  request_ = request;
  T_lidar_asked_ = options_.T_camera_lidar.inverse() * T_camera_board;
}

void GuidedBoard::DecideUntil(double time_s) {
  if (time_s <= decided_until_s_) return;
  const double free_from_s = std::max(decided_until_s_, RestsSince() + options_.hold_s);
  decided_until_s_ = time_s;
  if (end_s_ || free_from_s >= time_s) return;
  const bool is_last = static_cast<int>(stops_.size()) >= options_.num_poses;
  const bool is_new = request_ && request_ != followed_;
  const bool is_patience_over =
      request_ && free_from_s >= std::max(RestsSince(), set_out_s_) + kPatienceS;
  if (is_dismissed_ || (is_last && (is_new || is_patience_over))) {
    end_s_ = time_s;
  } else if (is_new || is_patience_over) {
    SetOut(free_from_s);
  }
}

double GuidedBoard::RestsSince() const {
  return stops_.size() == 1 ? 0.0 : stops_.back().leave_s + options_.move_s;
}

void GuidedBoard::SetOut(double leave_s) {
  set_out_s_ = leave_s;
  const auto T_lidar_board = Hold();
  ++num_holds_;
  followed_ = request_;
  if (T_lidar_board) stops_.push_back({leave_s, *T_lidar_board});
}

// Off by ever more where the room leaves no place.
std::optional<Eigen::Isometry3d> GuidedBoard::Hold() const {
  const KeyedNoise noise(options_.seed, NoiseUse::kHolds, num_holds_);
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const double scale = (1.0 + 4.0 * trial / kNumTrials) / std::sqrt(3.0);
    Vector6d error;
    for (int i = 0; i < 3; ++i) {
      const auto [turn, place] = noise.Normals(static_cast<std::uint64_t>(3 * trial + i));
      error[i] = scale * kTurnErrorRad * turn;
      error[3 + i] = scale * kPlaceErrorM * place;
    }
    const Eigen::Isometry3d T_lidar_board = PerturbLeft(T_lidar_asked_, error);
    if (simulation_.CanRestAt(T_lidar_board)) return T_lidar_board;
  }
  return std::nullopt;
}

}  // namespace voqcal
