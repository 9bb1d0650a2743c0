#include <filesystem>

#include <spdlog/spdlog.h>

#include "extrinsic_monitor/extrinsic_monitor_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig/session.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "extrinsic_monitor",
      "Tells from LIDAR_POINTS and CAMERA_IMAGE whether an extrinsic is still right, without a "
      "board: "
      "publishes EXTRINSIC_CHECK. The extrinsic is the session's, or the rig file's "
      "extrinsic_monitor: extrinsic."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    const std::filesystem::path extrinsic = rig.extrinsic_monitor.extrinsic.empty()
                                                ? voqcal::SessionFolder(args.session_dir, rig)
                                                : rig.extrinsic_monitor.extrinsic;
    voqcal::ExtrinsicMonitorNode node(rig, &bus, extrinsic);
    spdlog::info("watches {}", extrinsic.string());
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
