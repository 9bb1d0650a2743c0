// publish_extrinsic: a result as a rigid_transform_t, for live LCM systems.

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "common/tool_main.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/wall_clock.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct PublishArgs {
  std::filesystem::path result;
  std::filesystem::path rig;
  std::optional<std::string> lcm_url;
  bool is_once = false;
};

volatile std::sig_atomic_t is_stopped = 0;

// Once a second, as all state of voqcal: whoever starts late has it a second later. The stamp is
// the present: bot_frames takes a transform to hold from its stamp on.
void Publish(const PublishArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_lidar_camera = ReadExtrinsic(args.result).inverse();
  Bus bus(args.lcm_url.value_or(rig.lcm_url));
  std::signal(SIGINT, [](int) { is_stopped = 1; });
  std::signal(SIGTERM, [](int) { is_stopped = 1; });
  const std::string& channel = rig.channels.camera_to_lidar;
  std::printf("%s: p_lidar = q * p_camera + t (rigid_transform_t)\n", channel.c_str());
  std::fflush(stdout);
  do {
    bus.Publish(channel, RigidTransformMessage(T_lidar_camera, WallClockUs()));
    if (args.is_once) return;
    std::this_thread::sleep_for(std::chrono::seconds(1));
  } while (is_stopped == 0);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Publishes the extrinsic of a result once a second as bot_core's rigid_transform_t, which "
      "takes "
      "the camera's coordinates to the lidar's, on the rig's channel camera_to_lidar.",
      "publish_extrinsic");
  voqcal::PublishArgs args;
  app.add_option("result",
                 args.result,
                 "A result's folder or its extrinsic.yaml, or any YAML with T_camera_lidar")
      ->required();
  app.add_option("--rig", args.rig, "The rig file (YAML): network and channel")->required();
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  app.add_flag("--once", args.is_once, "Publish one message and end");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Publish(args); });
}
