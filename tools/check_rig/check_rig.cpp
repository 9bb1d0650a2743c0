// check_rig: reads a rig file as every module does, and says what is wrong with it or what it
// means.

#include <cstdio>
#include <filesystem>
#include <string>

#include <spdlog/spdlog.h>

#include "common/tool_main.hpp"
#include "core/camera_detection/calibration_target.hpp"
#include "rig/frame_pairing.hpp"
#include "rig/rig.hpp"
#include "rig/rig_doubts.hpp"

namespace voqcal {
namespace {

std::string LidarSourceOf(const Rig& rig) {
  switch (rig.lidar_driver.source) {
    case LidarDriverOptions::Source::kFolder:
      return "folder";
    case LidarDriverOptions::Source::kSimulator:
      return "simulator";
    case LidarDriverOptions::Source::kSensor:
      return rig.lidar_sensor.packets.protocol->name;
  }
  return "unknown";
}

std::string CameraSourceOf(const Rig& rig) {
  switch (rig.camera_driver.source) {
    case CameraDriverOptions::Source::kFolder:
      return "folder";
    case CameraDriverOptions::Source::kSimulator:
      return "simulator";
    case CameraDriverOptions::Source::kVideo:
      return "video";
    case CameraDriverOptions::Source::kGenicam:
      return "genicam";
  }
  return "unknown";
}

void PrintRig(const Rig& rig) {
  std::printf("rig        %s\n", rig.name.c_str());
  std::printf("lcm_url    %s\n", rig.lcm_url.c_str());
  std::printf("board      %.3f x %.3f m, %s of %d x %d corners, %s %.4g\n",
              rig.board.width_m,
              rig.board.height_m,
              rig.board.pattern.c_str(),
              rig.board.num_corners_x,
              rig.board.num_corners_y,
              SideKeyOf(rig.board).c_str(),
              rig.board.square_m);
  std::printf("camera     %s, %d x %d px, fx %.1f fy %.1f px\n",
              ToString(rig.camera.lens).c_str(),
              rig.camera.width_px,
              rig.camera.height_px,
              rig.camera.fx_px,
              rig.camera.fy_px);
  std::printf(
      "reads      %s, %s\n", rig.channels.lidar_points.c_str(), rig.channels.camera_image.c_str());
  std::printf("drivers    lidar: %s, camera: %s\n",
              LidarSourceOf(rig).c_str(),
              CameraSourceOf(rig).c_str());
}

/// @throws DemandNotMet with a line for each thing that is hardly meant so.
void JudgeRig(const Rig& rig) {
  std::string text;
  for (const std::string& doubt : RigDoubts(rig)) text += '\n' + rig.path.string() + ": " + doubt;
  if (!text.empty())
    throw DemandNotMet(rig.path.string() + ": can be read, but hardly be right:" + text);
  const std::string pairing = PairingOfDrivers(rig);
  if (!pairing.empty()) std::printf("frames     %s\n", pairing.c_str());
  std::printf("%s: is usable\n", rig.path.c_str());
}

// What calibrate reads of a recording, which also holds what the live modules made of it.
void PrintInputChannels(const Channels& channels) {
  std::printf("(%s|%s|%s|%s)\n",
              channels.lidar_points.c_str(),
              channels.camera_image.c_str(),
              channels.camera_info.c_str(),
              channels.calib_command.c_str());
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Checks a rig file as every module reads it, and says what it means. Exit status: 0 if it is "
      "usable, 1 if it is wrong, 3 if something in it can hardly be right.",
      "check_rig");
  std::filesystem::path path;
  bool is_url_only = false;
  bool is_channels_only = false;
  bool is_name_only = false;
  bool may_lack_lens = false;
  app.add_option("rig", path, "The rig file (YAML)")->required();
  app.add_flag("--name", is_name_only, "Print just the rig's name, for scripts");
  CLI::Option* url = app.add_flag("--lcm-url", is_url_only, "Print just the LCM URL, for scripts");
  app.add_flag("--without-lens", may_lack_lens, "The camera's numbers may be missing (to record)")
      ->needs(url);
  app.add_flag(
      "--input-channels",
      is_channels_only,
      "Print just the channels of sensors and operator, as a pattern for lcm-logplayer -e");
  return voqcal::RunTool(&app, argc, argv, [&] {
    // Scripts ask for these one after the other: what there is to remark was said with the URL.
    if (is_name_only || is_channels_only) spdlog::set_level(spdlog::level::err);
    voqcal::LensInRig lens;
    const voqcal::Rig rig = may_lack_lens ? voqcal::LoadRig(path, &lens) : voqcal::LoadRig(path);
    if (is_name_only) {
      std::puts(rig.name.c_str());
    } else if (is_url_only) {
      std::puts(rig.lcm_url.c_str());
    } else if (is_channels_only) {
      voqcal::PrintInputChannels(rig.channels);
    } else {
      voqcal::PrintRig(rig);
      voqcal::JudgeRig(rig);
    }
  });
}
