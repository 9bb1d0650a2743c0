#include <spdlog/spdlog.h>

#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "pose_guide/pose_guide_node.hpp"
#include "rig/rig.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "pose_guide",
      "Tells from samples and extrinsic where to hold the board next: publishes NEXT_POSE."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::PoseGuideNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
