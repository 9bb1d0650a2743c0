#include <spdlog/spdlog.h>

#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{"lidar_driver", "Publishes lidar sweeps as LIDAR_POINTS."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path, voqcal::SensorChoice::kLidar);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::LidarDriverNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
