#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/lidar_detection/accumulating_detector.hpp"
#include "core/lidar_detection/lidar_background.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {

/// LIDAR_POINTS in, LIDAR_BOARD out: one message for every sweep, with candidates or the reason for
/// none.
class LidarBoardDetectorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  LidarBoardDetectorNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "lidar_board_detector"; }

 private:
  void OnPoints(const pointcloud2_t& message);
  LidarBoardSighting Detect(const PointCloud& cloud, std::int64_t utime);

  Rig rig_;
  Bus& bus_;
  AccumulatingDetector detector_;
  LidarBackground background_;
  std::int64_t seq_ = 0;
};

}  // namespace voqcal
