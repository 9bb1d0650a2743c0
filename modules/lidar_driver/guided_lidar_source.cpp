#include "lidar_driver/guided_lidar_source.hpp"

#include <cmath>

#include "messaging/convert_result.hpp"
#include "messaging/convert_simulation.hpp"

namespace voqcal {
namespace {

// So long the camera driver's clock may be ahead of the lidar driver's without waiting for it.
constexpr double kLeadS = 0.5;

}  // namespace

GuidedLidarSource::GuidedLidarSource(const Rig& rig, Bus* bus)
    : options_(rig.simulation),
      simulation_(options_, rig.board, rig.camera),
      board_(options_, simulation_),
      rate_hz_(rig.lidar_driver.rate_hz),
      channel_(rig.channels.simulated_board),
      bus_(*bus) {
  bus_.Subscribe<next_pose_t>(
      rig.channels.next_pose, Queue::kState, [this](const next_pose_t& m) { Follow(m); });
}

std::optional<TimedCloud> GuidedLidarSource::Next() {
  const double time_s = static_cast<double>(num_sweeps_) / rate_hz_;
  board_.DecideUntil(time_s + kLeadS);
  bus_.Publish(channel_, ToMessage(board_, kSyntheticEpochUtime));
  has_ended_ = board_.end_s() && time_s > *board_.end_s();
  if (has_ended_) return {};
  ++num_sweeps_;
  return TimedCloud{kSyntheticEpochUtime + std::llround(time_s * 1e6),
                    simulation_.Sweep(time_s, PoseAt(time_s, board_.stops(), options_))};
}

std::string GuidedLidarSource::State() const {
  return "running: the board is at its stop " + std::to_string(board_.stops().size());
}

void GuidedLidarSource::Follow(const next_pose_t& message) {
  if (message.is_enough) return board_.Dismiss();
  if (message.problem.empty()) {
    board_.Ask(message.samples_revision, FromMessage(message.T_camera_board));
  }
}

}  // namespace voqcal
