#include <spdlog/spdlog.h>

#include "lidar_board_detector/lidar_board_detector_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "lidar_board_detector", "Finds the board in every LIDAR_POINTS and publishes LIDAR_BOARD."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path, voqcal::SensorChoice::kLidar);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::LidarBoardDetectorNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
