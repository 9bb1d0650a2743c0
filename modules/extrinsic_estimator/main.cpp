#include <spdlog/spdlog.h>

#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "extrinsic_estimator",
      "Calibrates each of VOQ_SETS and publishes their mean as EXTRINSIC_AVERAGED."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const voqcal::Rig rig = voqcal::LoadRig(args.rig_path);
    voqcal::Bus bus(args.lcm_url.value_or(rig.lcm_url));
    voqcal::ExtrinsicEstimatorNode node(rig, &bus);
    voqcal::Spin(bus, node, rig.channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
