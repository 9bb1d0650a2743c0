#include "lidar_driver/lidar_driver_node.hpp"

#include "messaging/convert_points.hpp"

namespace voqcal {

LidarDriverNode::LidarDriverNode(const Rig& rig, Bus* bus)
    : channel_(rig.channels.lidar_points),
      bus_(*bus),
      source_(MakeLidarSource(rig)),
      pacer_(rig.lidar_driver.rate_hz) {}

bool LidarDriverNode::Step() {
  if (is_done_ || !pacer_.IsDue()) return false;
  const std::optional<TimedCloud> sweep = source_->Next();
  if (!sweep) {
    is_done_ = true;
    return false;
  }
  bus_.Publish(channel_, ToMessage(sweep->cloud_lidar_m, sweep->utime, seq_++));
  Count("sweeps");
  pacer_.Advance();
  return false;
}

}  // namespace voqcal
