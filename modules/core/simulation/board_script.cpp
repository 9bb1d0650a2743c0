#include "core/simulation/board_script.hpp"

#include <algorithm>
#include <utility>

#include "core/simulation/stop_checks.hpp"
#include "core/simulation/stop_finder.hpp"

namespace voqcal {

BoardScript::BoardScript(const SimulationOptions& options,
                         const BoardSpec& board,
                         const CameraModel& camera,
                         const Room& room)
    : hold_s_(options.hold_s),
      move_s_(options.move_s),
      stops_(FindStops(options,
                       {StopFinder(options, camera, StopChecks(options, board, camera, room))})) {}

BoardScript::BoardScript(const SimulationOptions& options, std::vector<BoardPlace> stops)
    : hold_s_(options.hold_s), move_s_(options.move_s), stops_(std::move(stops)) {}

double BoardScript::DurationS() const {
  const auto num_stops = static_cast<double>(stops_.size());
  return num_stops * hold_s_ + (num_stops - 1) * move_s_;
}

BoardScript::Phase BoardScript::PhaseAt(double time_s) const {
  const double time_in_script_s = std::clamp(time_s, 0.0, DurationS());
  const double period_s = hold_s_ + move_s_;
  const auto last = static_cast<int>(stops_.size()) - 1;
  const int stop = std::min(static_cast<int>(time_in_script_s / period_s), last);
  const double moving_s = time_in_script_s - stop * period_s - hold_s_;
  return {stop, stop == last ? 0.0 : std::max(moving_s, 0.0)};
}

bool BoardScript::IsStill(double time_s) const { return PhaseAt(time_s).moving_s == 0; }

Eigen::Isometry3d BoardScript::T_lidar_board(double time_s) const {
  const Phase phase = PhaseAt(time_s);
  if (phase.moving_s == 0) return PoseOf(stops_[phase.stop]);
  return PoseOf(Between(stops_[phase.stop], stops_[phase.stop + 1], phase.moving_s / move_s_));
}

}  // namespace voqcal
