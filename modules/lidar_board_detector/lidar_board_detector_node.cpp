#include "lidar_board_detector/lidar_board_detector_node.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/format.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {
namespace {

// Nothing, and why, for a cloud that contradicts itself: one sweep's fault, not the module's.
std::optional<PointCloud> CloudOf(const pointcloud2_t& message, std::string* miss) try {
  return FromMessage(message);
} catch (const std::runtime_error& error) {
  *miss = error.what();
  return {};
}

}  // namespace

LidarBoardDetectorNode::LidarBoardDetectorNode(const Rig& rig, Bus* bus)
    : rig_(rig),
      bus_(*bus),
      detector_(rig.board, rig.lidar_board_detector),
      background_(rig.lidar_board_detector.background) {
  bus_.Subscribe<pointcloud2_t>(rig_.channels.lidar_points,
                                Queue::kEvery,
                                [this](const pointcloud2_t& message) { OnPoints(message); });
}

void LidarBoardDetectorNode::OnPoints(const pointcloud2_t& message) {
  std::string miss;
  std::int64_t accumulated_us = 0;
  std::vector<LidarBoard> candidates;
  if (const auto cloud = CloudOf(message, &miss)) {
    LidarBoardSighting found = Detect(*cloud, message.utime);
    accumulated_us = found.accumulated_us;
    if (found.boards) {
      candidates = std::move(*found.boards);
      Count("boards");
      if (accumulated_us > 0) Count("boards of several sweeps");
    } else {
      miss = ToString(found.boards.error());
      candidates = found.boards.error().unsure;
      Count(ToString(found.boards.error().miss));
    }
  } else {
    Count(WithoutNumbers(miss));  // by kind: each cloud of a broken driver is broken another way
  }
  bus_.Publish(rig_.channels.lidar_board,
               LidarBoardMessage(candidates, miss, message.utime, accumulated_us, seq_++));
}

LidarBoardSighting LidarBoardDetectorNode::Detect(const PointCloud& cloud, std::int64_t utime) {
  if (!rig_.lidar_board_detector.background.is_used) return detector_.Detect(cloud, utime);
  LidarBoardSighting found = detector_.Detect(cloud, utime, &background_);
  background_.Learn(cloud);
  return found;
}

}  // namespace voqcal
