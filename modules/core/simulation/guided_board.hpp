#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/simulation/simulation.hpp"

namespace voqcal {

/// Where a board rests, and when it sets out for there.
struct BoardStop {
  double leave_s = 0.0;  ///< From the stop before; of the first it does not count.
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
};

/// Where a board with these stops is at a time.
/// @param stops  at least one, in order of time.
Eigen::Isometry3d PoseAt(double time_s,
                         const std::vector<BoardStop>& stops,
                         const SimulationOptions& options);

/// A simulated person who holds the board where the guidance asks for: about there, for as long as
/// it takes until something else is asked for. Who is asked for nothing else in five seconds tries
/// somewhere near: sensors that do not find the board say nothing.
class GuidedBoard {
 public:
  /// Begins at the script's first stop.
  /// @param simulation  with these options; borrowed.
  GuidedBoard(const SimulationOptions& options, const Simulation& simulation);

  /// From now on the board is wanted there.
  /// @param request  another number is another request.
  void Ask(std::int64_t request, const Eigen::Isometry3d& T_camera_board);

  /// It is enough: the board stays where it is, and the session ends when it has rested.
  void Dismiss() { is_dismissed_ = true; }

  /// Decides all that happens before `time_s`, which never goes back.
  void DecideUntil(double time_s);

  const std::vector<BoardStop>& stops() const { return stops_; }

  double decided_until_s() const { return decided_until_s_; }

  /// When the session ends, once that is decided.
  std::optional<double> end_s() const { return end_s_; }

 private:
  double RestsSince() const;
  void SetOut(double leave_s);
  std::optional<Eigen::Isometry3d> Hold() const;

  const SimulationOptions& options_;
  const Simulation& simulation_;
  std::vector<BoardStop> stops_;
  double decided_until_s_ = 0.0;
  std::optional<std::int64_t> request_;   // the newest...
  std::optional<std::int64_t> followed_;  // ...and the last that the board set out for
  Eigen::Isometry3d T_lidar_asked_ = Eigen::Isometry3d::Identity();
  double set_out_s_ = 0.0;      // or tried to, last
  std::int64_t num_holds_ = 1;  // each is off by something else
  bool is_dismissed_ = false;
  std::optional<double> end_s_;
};

}  // namespace voqcal
