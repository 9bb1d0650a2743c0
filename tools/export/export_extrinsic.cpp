// export_extrinsic: a result as other programs take it.

#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "common/output_file.hpp"
#include "common/tool_main.hpp"
#include "files/atomic_file.hpp"
#include "result/extrinsic_text.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct ExportArgs {
  std::filesystem::path result;
  std::string format;
  ExportedExtrinsic extrinsic;
  std::optional<std::filesystem::path> rig;
  OutputFile out;
};

void Export(ExportArgs args) {
  for (const std::string& problem : args.extrinsic.Problems()) throw std::runtime_error(problem);
  args.extrinsic.T_camera_lidar = ReadExtrinsic(args.result);
  const std::filesystem::path file = ResultFileAt(args.result);
  if (IsToBeMended(ReadWholeFile(file), file.string())) {
    spdlog::warn("{}: its verdict is: do not use it; the result says why", file.string());
  }
  if (args.rig) args.extrinsic.camera = LoadRig(*args.rig).camera;
  const std::string text = ExtrinsicText(args.format, args.extrinsic);
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
  std::string formats;
  for (const std::string& name : voqcal::ExportFormats()) formats += " " + name;
  app.add_option("result",
                 args.result,
                 "A result's folder or its extrinsic.yaml, or any YAML with T_camera_lidar")
      ->required();
  app.add_option("--format", args.format, "One of:" + formats)->required();
  app.add_option("--parent", args.extrinsic.parent, "Name of the lidar's frame")
      ->capture_default_str();
  app.add_option("--child", args.extrinsic.child, "Name of the camera's optical frame")
      ->capture_default_str();
  app.add_option("--rig", args.rig, "The rig file (YAML): adds the lens where the format has one");
  voqcal::AddOutputFile(&app, "File to write; without it the terminal", &args.out);
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Export(args); });
}
