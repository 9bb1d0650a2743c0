#include <spdlog/spdlog.h>

#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "voq_selector/voq_selector_node.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "voq_selector", "Chooses the sets of lowest VOQ among CALIB_SAMPLES and publishes VOQ_SETS."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::VoqSelectorNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
