#include <spdlog/spdlog.h>

#include "camera_board_detector/camera_board_detector_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "camera_board_detector", "Finds the board in every CAMERA_IMAGE and publishes CAMERA_BOARD."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path, voqcal::SensorChoice::kCamera);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::CameraBoardDetectorNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
