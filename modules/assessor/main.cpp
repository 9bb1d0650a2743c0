#include <spdlog/spdlog.h>

#include "assessor/assessor_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig/session.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "assessor",
      "Scores the extrinsics over the whole scene: CALIB_ASSESSMENT and extrinsic.yaml."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::AssessorNode node(rig, &bus, voqcal::SessionFolder(args.session_dir, rig));
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
