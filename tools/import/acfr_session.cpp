#include "import/acfr_session.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/progress.hpp"
#include "files/atomic_file.hpp"
#include "files/point_cloud_file.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/log.hpp"
#include "rig/frame_folder.hpp"

namespace voqcal {
namespace {

template <typename Message>
std::vector<std::uint8_t> Encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// Numbers the events; their time is the frame's, so that lcm-logplayer paces them.
class EventWriter {
 public:
  explicit EventWriter(const std::filesystem::path& log) : writer_(log) {}

  template <typename Message>
  void Write(const std::string& channel, const Message& message) {
    writer_.Write({next_number_++, message.utime, channel, Encode(message)});
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
  Session(const std::filesystem::path& folder, double rate_hz)
      : name(folder.filename().string()),
        clouds(FolderOptions(folder / "pcd", "_full.pcd", rate_hz), {".pcd"}),
        images(FolderOptions(folder / "images", "", rate_hz), {".png", ".jpg"}) {}

  std::string name;
  FrameFolder clouds;
  FrameFolder images;
};

}  // namespace

ImportedFrames ImportAcfrSession(const std::filesystem::path& folder,
                                 const Rig& rig,
                                 double rate_hz,
                                 const std::filesystem::path& log) {
  Session session(folder, rate_hz);
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
  return {num_clouds, num_images};
}

}  // namespace voqcal
