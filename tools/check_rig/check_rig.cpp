// check_rig: reads a rig file as every module does, and says what is wrong with it or what it
// means.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/tool_main.hpp"
#include "core/camera_detection/calibration_target.hpp"
#include "core/format.hpp"
#include "health/session_programs.hpp"
#include "rig/default_rig.hpp"
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

std::string LensOf(const CameraModel& camera) {
  return Format("%s, %d x %d px, fx %.1f fy %.1f px",
                ToString(camera.lens).c_str(),
                camera.width_px,
                camera.height_px,
                camera.fx_px,
                camera.fy_px);
}

void PrintShared(const std::string& name, const Rig& rig) {
  std::printf("rig        %s\n", name.c_str());
  std::printf("lcm_url    %s\n", rig.lcm_url.c_str());
  std::printf("board      %.3f x %.3f m, %s of %d x %d corners, %s %.4g\n",
              rig.board.width_m,
              rig.board.height_m,
              rig.board.pattern.c_str(),
              rig.board.num_corners_x,
              rig.board.num_corners_y,
              SideKeyOf(rig.board).c_str(),
              rig.board.square_m);
}

void PrintRig(const Rig& rig) {
  PrintShared(rig.name, rig);
  std::printf("camera     %s\n", LensOf(rig.camera).c_str());
  std::printf(
      "reads      %s, %s\n", rig.channels.lidar_points.c_str(), rig.channels.camera_image.c_str());
  std::printf("drivers    lidar: %s, camera: %s\n",
              LidarSourceOf(rig).c_str(),
              CameraSourceOf(rig).c_str());
}

/// A file's sensors, each once, and the names of its pairs.
void PrintPairs(const std::vector<Rig>& pairs) {
  PrintShared(pairs.front().rig_name, pairs.front());
  std::set<std::string> told;
  for (const Rig& rig : pairs) {
    if (!told.insert(rig.lidar_name).second) continue;
    std::printf("lidar      %s: reads %s, driver: %s\n",
                rig.lidar_name.c_str(),
                rig.channels.lidar_points.c_str(),
                LidarSourceOf(rig).c_str());
  }
  for (const Rig& rig : pairs) {
    if (!told.insert(rig.camera_name).second) continue;
    std::printf("camera     %s: %s, reads %s, driver: %s\n",
                rig.camera_name.c_str(),
                LensOf(rig.camera).c_str(),
                rig.channels.camera_image.c_str(),
                CameraSourceOf(rig).c_str());
  }
  for (const Rig& rig : pairs) std::printf("pair       %s\n", rig.path.c_str());
}

std::vector<std::string> DoubtsOf(const std::vector<Rig>& pairs) {
  std::vector<std::string> lines;
  for (const Rig& rig : pairs) {
    for (const std::string& doubt : RigDoubts(rig)) {
      const std::string line = rig.path.string() + ": " + doubt;
      if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
    }
  }
  return lines;
}

/// Folders may hold what was recorded of a board at rest, or one frame of each place.
void TellStillness(const Rig& rig) {
  const int num_still_frames = rig.sample_collector.num_still_frames;
  if (num_still_frames <= 1) return;
  std::printf(
      "rests      through %d frames of each place (sample_collector.num_still_frames; 1, if "
      "the folders have one frame of each)\n",
      num_still_frames);
}

/// @throws DemandNotMet with a line for each thing that is hardly meant so.
void JudgeRigs(const std::filesystem::path& path, const std::vector<Rig>& pairs) {
  std::string text;
  for (const std::string& line : DoubtsOf(pairs)) text += '\n' + line;
  if (!text.empty()) {
    throw DemandNotMet(path.string() + ": can be read, but can hardly be right:" + text);
  }
  for (const Rig& rig : pairs) {
    const std::string pairing = PairingOfDrivers(rig);
    if (pairing.empty()) continue;
    TellStillness(rig);
    const std::string whose = rig.lidar_name + ", " + rig.camera_name + ": ";
    std::printf("frames     %s%s\n", pairs.size() > 1 ? whose.c_str() : "", pairing.c_str());
  }
  std::printf("%s: is usable\n", path.c_str());
}

/// A line each: name, module, sensors ("-": as the rig was given), folder within the session's.
void PrintPrograms(const std::filesystem::path& path) {
  for (const SessionProgram& program : ProgramsOfRig(path)) {
    std::printf("%s\t%s\t%s\t%s\n",
                program.name.c_str(),
                program.module.c_str(),
                program.sensors.empty() ? "-" : program.sensors.c_str(),
                program.folder.empty() ? "." : program.folder.c_str());
  }
}

/// All pairs share it; a rig in which another pair is wrong is wrong.
std::string LcmUrlOf(const std::filesystem::path& path, bool may_lack_lens) {
  if (!may_lack_lens) return LoadPairs(path).front().lcm_url;
  LensInRig lens;
  return LoadRig(PairsOfRig(path).front(), &lens).lcm_url;
}

std::string NameOf(const std::filesystem::path& path) {
  const std::vector<Rig> pairs = LoadPairs(path);
  return pairs.size() == 1 ? pairs.front().name : pairs.front().rig_name;
}

// What calibrate reads of a recording, which also holds what the live modules made of it.
void PrintInputChannels(const std::vector<Rig>& pairs) {
  std::vector<std::string> names;
  for (const Rig& rig : pairs) {
    const Channels& channels = rig.channels;
    for (const std::string& name : {channels.lidar_points,
                                    channels.camera_image,
                                    channels.camera_info,
                                    channels.calib_command}) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : "|") + name;
  std::printf("(%s)\n", text.c_str());
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
  bool is_programs_only = false;
  bool may_lack_lens = false;
  app.add_option("rig", path, "The rig file (YAML)")->required();
  app.add_flag_callback(
      "--print-defaults",
      [] {
        std::fputs(voqcal::DefaultRigText().c_str(), stdout);
        throw CLI::Success();
      },
      "Print a rig file that explains every key, with its default; no rig file is needed");
  app.add_flag("--name", is_name_only, "Print just the rig's name, for scripts");
  app.add_flag("--programs",
               is_programs_only,
               "Print just what a live session runs, for scripts: name, module, sensors, folder");
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
    if (is_url_only) {
      std::puts(voqcal::LcmUrlOf(path, may_lack_lens).c_str());
    } else if (is_name_only) {
      std::puts(voqcal::NameOf(path).c_str());
    } else if (is_programs_only) {
      voqcal::PrintPrograms(path);
    } else if (is_channels_only) {
      voqcal::PrintInputChannels(voqcal::LoadPairs(path));
    } else {
      const std::vector<voqcal::Rig> pairs = voqcal::LoadPairs(path, voqcal::PairLine::kIsIgnored);
      if (pairs.size() == 1) {
        voqcal::PrintRig(pairs.front());
      } else {
        voqcal::PrintPairs(pairs);
      }
      voqcal::JudgeRigs(path, pairs);
    }
  });
}
