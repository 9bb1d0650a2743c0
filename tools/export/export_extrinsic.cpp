// export_extrinsic: a result as other programs take it.

#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "common/output_file.hpp"
#include "common/tool_main.hpp"
#include "files/atomic_file.hpp"
#include "result/extrinsic_text.hpp"
#include "result/result_file.hpp"
#include "result/rig_extrinsics.hpp"
#include "result/tree_text.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

constexpr char kDoNotUse[] = "{}: its verdict is: do not use it; the result says why";

struct ExportArgs {
  std::filesystem::path result;
  std::string format;
  ExportedExtrinsic extrinsic;
  bool has_frames = false;  ///< They are given.
  std::optional<std::filesystem::path> rig;
  OutputFile out;
};

/// The lenses of a rig file's cameras, by name.
std::map<std::string, CameraModel> CamerasOf(const std::optional<std::filesystem::path>& rig) {
  std::map<std::string, CameraModel> cameras;
  if (!rig) return cameras;
  for (const Rig& pair : LoadPairs(*rig)) cameras[pair.camera_name] = pair.camera;
  return cameras;
}

std::string TextOfRig(const ExportArgs& args, const std::filesystem::path& file) {
  if (args.has_frames) {
    throw std::runtime_error(
        file.string() +
        ": is of a rig, whose sensors are their own frames: leave out --parent "
        "and --child");
  }
  const SensorTree tree = ReadSensorTree(file);
  if (tree.is_to_be_mended) spdlog::warn(kDoNotUse, file.string());
  const std::map<std::string, CameraModel> cameras = CamerasOf(args.rig);
  if (args.rig && args.format == "kalibr") {
    for (const std::string& name : CamerasWithoutKalibrLens(tree, cameras)) {
      spdlog::warn(
          "{}: the camchain has no lens of {}: {}",
          args.rig->string(),
          name,
          cameras.count(name) == 0 ? "the rig file has no such camera" : "Kalibr has no such lens");
    }
  }
  return TreeText(args.format, tree, cameras);
}

std::string TextOfPair(ExportArgs args) {
  for (const std::string& problem : args.extrinsic.Problems()) throw std::runtime_error(problem);
  args.extrinsic.T_child_parent = ReadExtrinsic(args.result);
  const std::filesystem::path file = ResultFileAt(args.result);
  if (IsToBeMended(ReadWholeFile(file), file.string())) {
    spdlog::warn(kDoNotUse, file.string());
  }
  if (args.rig) args.extrinsic.camera = LoadRig(*args.rig).camera;
  if (args.rig && args.format == "kalibr" && KalibrLens(*args.extrinsic.camera).empty()) {
    spdlog::warn("{}: the camchain has no lens: Kalibr has no such lens", args.rig->string());
  }
  return ExtrinsicText(args.format, args.extrinsic);
}

void Export(const ExportArgs& args) {
  const std::optional<std::filesystem::path> of_rig = RigResultFileAt(args.result);
  const std::string text = of_rig ? TextOfRig(args, *of_rig) : TextOfPair(args);
  if (!args.out.path.empty()) {
    args.out.Prepare();
    WriteFileAtomically(args.out.path, text);
  } else {
    std::cout << text;
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Writes the extrinsic of a result as other programs take it.", "export_extrinsic");
  voqcal::ExportArgs args;
  std::string formats = "One of:";
  for (const std::string& name : voqcal::ExportFormats()) formats += " " + name;
  formats += "; of a rig:";
  for (const std::string& name : voqcal::TreeFormats()) formats += " " + name;
  app.add_option(
         "result",
         args.result,
         "A result's folder or its extrinsic.yaml, or any YAML with T_camera_lidar; or those "
         "of a rig (rig_extrinsics.yaml)")
      ->required();
  app.add_option("--format", args.format, formats)->required();
  CLI::Option* parent =
      app.add_option("--parent", args.extrinsic.parent, "Name of the lidar's frame")
          ->capture_default_str();
  CLI::Option* child =
      app.add_option("--child", args.extrinsic.child, "Name of the camera's optical frame")
          ->capture_default_str();
  app.add_option("--rig", args.rig, "The rig file (YAML): adds the lens where the format has one");
  voqcal::AddOutputFile(&app, "File to write; without it the terminal", &args.out);
  return voqcal::RunTool(&app, argc, argv, [&] {
    args.has_frames = parent->count() + child->count() > 0;
    voqcal::Export(args);
  });
}
