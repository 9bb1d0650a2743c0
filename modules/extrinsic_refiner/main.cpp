#include <spdlog/spdlog.h>

#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/session_views.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig/session.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "extrinsic_refiner",
      "Refines EXTRINSIC_AVERAGED over all samples and publishes EXTRINSIC_REFINED."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::ExtrinsicRefinerNode node(
        rig,
        &bus,
        voqcal::ViewsOfSession(
            rig.board,
            rig.camera,
            rig.scene_check.view,
            voqcal::SessionFolder(args.session_dir, rig) / voqcal::kSamplesLogName));
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
