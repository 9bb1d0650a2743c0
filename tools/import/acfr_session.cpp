#include "import/acfr_session.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>
#include <system_error>

#include "common/progress.hpp"
#include "files/atomic_file.hpp"
#include "files/point_cloud_file.hpp"
#include "import/session_folders.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "rig/frame_folder.hpp"
#include "rig/frame_pairing.hpp"

namespace voqcal {
namespace {

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

FrameOptions FolderOptions(const std::filesystem::path& folder,
                           const std::string& file_ending,
                           const AcfrImportOptions& import) {
  FrameOptions options;
  options.folder = folder;
  options.file_ending = file_ending;
  options.rate_hz = import.rate_hz;
  options.is_by_order = import.is_paired_by_order;
  return options;
}

// cam_lidar_calibration writes three clouds a pose, of which the full one is wanted; others one.
std::string CloudEnding(const std::filesystem::path& folder) {
  const std::string ending = "_full.pcd";
  std::error_code error;  // a missing folder is told by who reads it
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_full = name.front() != '.' && name.size() >= ending.size() &&
                         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
    if (is_full) return ending;
  }
  return "";
}

image_t ImageMessage(const FrameFile& file, std::int64_t seq) {
  const std::string bytes = ReadWholeFile(file.path);
  try {
    const image_t message = EncodedToMessage({bytes.begin(), bytes.end()}, file.utime, seq);
    RequireSound(message);
    return message;
  } catch (const std::exception& error) {
    throw std::runtime_error(file.path.string() + ": " + error.what());
  }
}

struct Session {
  /// @throws std::runtime_error naming the folder that is missing or empty.
  Session(const std::filesystem::path& folder, const AcfrImportOptions& options)
      : Session(folder.filename().string(), FindSessionFolders(folder), options) {}
  Session(std::string session_name, const SessionFolders& folders, const AcfrImportOptions& options)
      : name(std::move(session_name)),
        clouds(FolderOptions(folders.clouds, CloudEnding(folders.clouds), options), kCloudEndings),
        images(FolderOptions(folders.images, "", options), kImageEndings) {}

  std::string name;
  FrameFolder clouds;
  FrameFolder images;
};

/// Pieces of one sort: those that went into the log, and those that could not be read.
class Pieces {
 public:
  explicit Pieces(std::string what) : what_(std::move(what)) {}

  /// Reads one and writes it, or counts it as left out: one bad piece must not cost the others.
  /// What cannot be written does: a full disk is no fault of a piece.
  template <typename Read, typename Write>
  void Take(const Read& read, const Write& write) {
    std::optional<decltype(read(num_taken_))> piece;
    try {
      piece = read(num_taken_);
    } catch (const std::runtime_error& error) {
      if (num_left_out_++ < kMaxNamed) spdlog::warn("left out: {}", error.what());
      return;
    }
    write(*piece);
    ++num_taken_;
  }

  std::size_t num_taken() const { return static_cast<std::size_t>(num_taken_); }
  std::size_t num() const { return static_cast<std::size_t>(num_taken_) + num_left_out_; }

  /// @throws std::runtime_error if there is none.
  std::string Words() const {
    if (num_taken_ == 0) throw std::runtime_error("none of the " + what_ + " can be read");
    const std::string rest =
        num_left_out_ == 0 ? "" : " (" + std::to_string(num_left_out_) + " left out)";
    return std::to_string(num_taken_) + " " + what_ + rest;
  }

 private:
  static constexpr std::size_t kMaxNamed = 5;
  std::string what_;
  std::int64_t num_taken_ = 0;
  std::size_t num_left_out_ = 0;
};

/// How many images are not of the camera's size, and what the first one's is.
class OtherSizes {
 public:
  explicit OtherSizes(const CameraModel& camera) : camera_(camera) {}

  void See(const image_t& image) {
    if (image.width == camera_.width_px && image.height == camera_.height_px) return;
    if (num_++ == 0) first_ = SizeText(image.width, image.height);
  }

  /// Empty if all are of its size.
  std::string Doubt() const {
    if (num_ == 0) return "";
    return "images that are not of the camera's size: " + std::to_string(num_) +
           " (the first is of " + first_ + " px, camera.width_px x height_px are " +
           SizeText(camera_.width_px, camera_.height_px) +
           "): no board is looked for in them. Give the size and the intrinsics of these images";
  }

 private:
  static std::string SizeText(int width_px, int height_px) {
    return std::to_string(width_px) + " x " + std::to_string(height_px);
  }

  const CameraModel& camera_;
  std::size_t num_ = 0;
  std::string first_;
};

/// Such a session has one frame of each place, so the board cannot be seen to rest.
std::string StillnessDoubt(const Rig& rig) {
  const int num_still_frames = rig.sample_collector.num_still_frames;
  if (num_still_frames <= 1) return "";
  return "sample_collector.num_still_frames is " + std::to_string(num_still_frames) +
         ": where each place has one cloud and one image let it be 1, or none becomes a sample";
}

ImportedFrames WriteFrames(Session session, const Rig& rig, const std::filesystem::path& log) {
  Progress progress("importing " + session.name);
  EventWriter events(log);
  Pieces clouds("clouds");
  Pieces images("images");
  OtherSizes other_sizes(rig.camera);
  auto cloud = session.clouds.Next();
  auto image = session.images.Next();
  while (cloud || image) {
    if (cloud && (!image || cloud->utime <= image->utime)) {
      clouds.Take(
          [&](std::int64_t seq) {
            return ToMessage(
                ReadPointCloud(cloud->path), cloud->utime, static_cast<std::int32_t>(seq));
          },
          [&](const auto& message) { events.Write(rig.channels.lidar_points, message); });
      cloud = session.clouds.Next();
    } else {
      const auto seq_of_info = static_cast<std::int64_t>(images.num_taken());
      images.Take([&](std::int64_t seq) { return ImageMessage(*image, seq); },
                  [&](const image_t& message) {
                    other_sizes.See(message);
                    events.Write(rig.channels.camera_info,
                                 ToMessage(rig.camera, image->utime, seq_of_info));
                    events.Write(rig.channels.camera_image, message);
                  });
      image = session.images.Next();
    }
    progress.Show(static_cast<double>(clouds.num() + images.num()) /
                      static_cast<double>(session.clouds.size() + session.images.size()),
                  std::to_string(images.num()) + " images");
  }
  events.Flush();
  ImportedFrames frames;
  frames.num_clouds = clouds.num_taken();
  frames.num_images = images.num_taken();
  frames.text = clouds.Words() + " and " + images.Words();
  for (const std::string& doubt : {other_sizes.Doubt(), StillnessDoubt(rig)}) {
    if (!doubt.empty()) frames.doubts.push_back(doubt);
  }
  return frames;
}

}  // namespace

void RequireAcfrSession(const std::filesystem::path& folder, const AcfrImportOptions& options) {
  const Session session(folder, options);
}

ImportedFrames ImportAcfrSession(const std::filesystem::path& folder,
                                 const Rig& rig,
                                 const AcfrImportOptions& options,
                                 const std::filesystem::path& log) {
  Session session(folder, options);
  const std::string pairing =
      PairingOf(session.clouds, session.images, rig.sample_collector.max_pair_offset_s);
  ImportedFrames frames = WriteFrames(std::move(session), rig, log);
  frames.pairing = pairing;
  return frames;
}

}  // namespace voqcal
