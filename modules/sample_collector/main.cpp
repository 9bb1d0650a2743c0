#include <spdlog/spdlog.h>

#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig/session.hpp"
#include "sample_collector/sample_collector_node.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "sample_collector",
      "Pairs LIDAR_BOARD and CAMERA_BOARD and keeps the samples as CALIB_SAMPLES."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    const auto session_folder = voqcal::SessionFolder(args.session_dir, rig);
    voqcal::SampleCollectorNode node(rig, &bus, session_folder);
    spdlog::info("{}: {} samples so far", session_folder.string(), node.samples().size());
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
