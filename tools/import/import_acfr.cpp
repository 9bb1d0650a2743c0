// import_acfr: the folders of a cam_lidar_calibration session to an LCM log.

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <system_error>

#include "common/output_file.hpp"
#include "common/progress.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "files/atomic_file.hpp"
#include "files/point_cloud_file.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "rig/frame_folder.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct ImportArgs {
  std::filesystem::path session;
  std::filesystem::path rig;
  OutputFile out;
  double rate_hz = 2.0;
};

// Numbers the events; their time is the frame's, so that lcm-logplayer paces them.
class EventWriter {
 public:
  explicit EventWriter(const std::filesystem::path& log) : writer_(log) {}

  template <typename Message>
  void Write(const std::string& channel, const Message& message) {
    writer_.Write({next_number_++, message.utime, channel, EncodeMessage(message)});
  }
  void Flush() { writer_.Flush(); }

 private:
  LogWriter writer_;
  std::int64_t next_number_ = 0;
};

DriverOptions FolderOptions(const std::filesystem::path& folder,
                            const std::string& file_ending,
                            double rate_hz) {
  DriverOptions options;
  options.folder = folder;
  options.file_ending = file_ending;
  options.rate_hz = rate_hz;
  return options;
}

image_t ImageMessage(const FrameFile& file, std::int64_t seq) {
  const std::string bytes = ReadWholeFile(file.path);
  try {
    return EncodedToMessage({bytes.begin(), bytes.end()}, file.utime, seq);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.path.string() + ": " + error.what());
  }
}

struct Session {
  /// @throws std::runtime_error naming the folder that is missing or empty.
  explicit Session(const ImportArgs& args)
      : name(args.session.filename().string()),
        clouds(FolderOptions(args.session / "pcd", "_full.pcd", args.rate_hz), {".pcd"}),
        images(FolderOptions(args.session / "images", "", args.rate_hz), {".png", ".jpg"}) {}

  std::string name;
  FrameFolder clouds;
  FrameFolder images;
};

void WriteFrames(Session session, const Rig& rig, const std::filesystem::path& log) {
  FrameFolder& clouds = session.clouds;
  FrameFolder& images = session.images;
  Progress progress("importing " + session.name);
  EventWriter events(log);
  std::size_t num_clouds = 0;
  std::size_t num_images = 0;
  auto cloud = clouds.Next();
  auto image = images.Next();
  while (cloud || image) {
    if (cloud && (!image || cloud->utime <= image->utime)) {
      events.Write(
          rig.channels.lidar_points,
          ToMessage(
              ReadPointCloud(cloud->path), cloud->utime, static_cast<std::int32_t>(num_clouds++)));
      cloud = clouds.Next();
    } else {
      const auto seq = static_cast<std::int64_t>(num_images++);
      events.Write(rig.channels.camera_info, ToMessage(rig.camera, image->utime, seq));
      events.Write(rig.channels.camera_image, ImageMessage(*image, seq));
      image = images.Next();
    }
    progress.Show(static_cast<double>(num_clouds + num_images) /
                      static_cast<double>(clouds.size() + images.size()),
                  std::to_string(num_images) + " images");
  }
  events.Flush();
  std::cout << num_clouds << " clouds and " << num_images << " images\n";
}

void Import(const ImportArgs& args) {
  const Rig rig = LoadRig(args.rig);
  Session session(args);
  args.out.Prepare();
  const ScratchFolder scratch(args.out.path);
  const std::filesystem::path log = scratch.path() / "import.lcm";
  WriteFrames(std::move(session), rig, log);
  std::error_code error;
  std::filesystem::rename(log, args.out.path, error);
  if (error)
    throw std::runtime_error(args.out.path.string() + ": cannot write: " + error.message());
  std::cout << "written\n  " << args.out.path.string() << '\n';
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
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Import(args); });
}
