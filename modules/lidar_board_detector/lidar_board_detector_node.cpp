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
    : rig_(rig), bus_(*bus), background_(rig.lidar_board_detector.background) {
  bus_.Subscribe<pointcloud2_t>(rig_.channels.lidar_points,
                                Queue::kEvery,
                                [this](const pointcloud2_t& message) { OnPoints(message); });
}

void LidarBoardDetectorNode::OnPoints(const pointcloud2_t& message) {
  std::string miss;
  std::vector<LidarBoard> candidates;
  if (const auto cloud = CloudOf(message, &miss)) {
    auto found = Detect(*cloud);
    if (found) {
      candidates = std::move(*found);
      Count("boards");
    } else {
      miss = ToString(found.error());
      candidates = found.error().unsure;
      Count(ToString(found.error().miss));
    }
  } else {
    Count(WithoutNumbers(miss));  // by kind: each cloud of a broken driver is broken another way
  }
  bus_.Publish(rig_.channels.lidar_board,
               LidarBoardMessage(candidates, miss, message.utime, seq_++));
}

Expected<std::vector<LidarBoard>, NoLidarBoard> LidarBoardDetectorNode::Detect(
    const PointCloud& cloud) {
  const LidarBoardOptions& options = rig_.lidar_board_detector;
  if (!options.background.is_used) return DetectLidarBoard(cloud, rig_.board, options);
  auto found = DetectLidarBoard(cloud, rig_.board, options, &background_);
  background_.Learn(cloud);
  return found;
}

}  // namespace voqcal
