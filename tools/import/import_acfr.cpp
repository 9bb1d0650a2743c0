// import_acfr: the folders of a cam_lidar_calibration session to an LCM log.

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>
#include <system_error>

#include "common/output_file.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "import/acfr_session.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct ImportArgs {
  std::filesystem::path session;
  std::filesystem::path rig;
  OutputFile out;
  double rate_hz = 2.0;
  std::string pair = "names";
};

void Import(const ImportArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const AcfrImportOptions options{args.rate_hz, args.pair == "order"};
  RequireAcfrSession(args.session, options);  // before a folder is made
  args.out.Prepare();
  const ScratchFolder scratch(args.out.path);
  const std::filesystem::path log = scratch.path() / "import.lcm";
  const ImportedFrames frames = ImportAcfrSession(args.session, rig, options, log);
  std::error_code error;
  std::filesystem::rename(log, args.out.path, error);
  if (error)
    throw std::runtime_error(args.out.path.string() + ": cannot write: " + error.message());
  for (const std::string& doubt : frames.doubts) {
    spdlog::warn("{}: {}", args.rig.string(), doubt);
  }
  std::cout << frames.text << '\n'
            << frames.pairing << "\nwritten\n  " << args.out.path.string() << '\n';
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Turns a session of cam_lidar_calibration (images/poseN.png, pcd/poseN_full.pcd) into an LCM "
      "log of LIDAR_POINTS, CAMERA_IMAGE and CAMERA_INFO. Images are passed on as they are.",
      "import_acfr");
  voqcal::ImportArgs args;
  app.add_option("session", args.session, "The session's folder")->required();
  app.add_option("--rig", args.rig, "The rig file (YAML): camera and channels")->required();
  voqcal::AddOutputFile(&app, "The log to write", &args.out)->required();
  app.add_option("--rate", args.rate_hz, "Poses a second when the log is replayed")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option(
         "--pair",
         args.pair,
         "Which cloud belongs to which image: by the numbers or times in their names, or by "
         "their order in the folder")
      ->capture_default_str()
      ->check(CLI::IsMember({"names", "order"}));
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Import(args); });
}
