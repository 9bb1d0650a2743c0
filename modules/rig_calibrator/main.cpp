#include <stdexcept>
#include <vector>

#include <spdlog/spdlog.h>

#include "messaging/bus.hpp"
#include "messaging/process.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig_calibrator/rig_calibrator_node.hpp"

int main(int argc, char** argv) {
  const voqcal::ProcessInfo info{
      "rig_calibrator",
      "Calibrates every pair of a rig of several sensors from its CALIB_SAMPLES, and joins them: "
      "RIG_EXTRINSICS."};
  return voqcal::RunProcess(argc, argv, info, [](const voqcal::ProcessArgs& args) {
    const std::vector<voqcal::Rig> pairs = voqcal::LoadPairs(args.rig_path);
    if (pairs.size() < 2) {
      throw std::runtime_error(args.rig_path.string() +
                               ": is one pair, whose own modules calibrate it: tools/up starts "
                               "them, calibrate takes a recording");
    }
    if (!args.session_dir) {
      throw std::runtime_error(
          "--session is missing: the folder that has those of the pairs' collectors");
    }
    voqcal::Bus bus(args.lcm_url.value_or(pairs.front().lcm_url));
    voqcal::RigCalibratorNode node(pairs, &bus, *args.session_dir);
    voqcal::Spin(bus, node, pairs.front().channels.module_status, args);
    spdlog::info(node.Summary());
  });
}
