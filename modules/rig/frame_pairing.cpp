#include "rig/frame_pairing.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

namespace voqcal {
namespace {

std::string NameOf(const FrameFile& file) { return file.path.filename().string(); }

std::string ToString(FrameNaming naming) {
  switch (naming) {
    case FrameNaming::kNumbers:
      return "numbers";
    case FrameNaming::kTimes:
      return "times";
    case FrameNaming::kPlaces:
      break;
  }
  return "no numbers, or the same twice";
}

[[noreturn]] void Refuse(const FrameFolder& clouds,
                         const FrameFolder& images,
                         const std::string& problem) {
  const FrameFile& cloud = clouds.files().front();
  const FrameFile& image = images.files().front();
  throw std::runtime_error(
      cloud.path.parent_path().string() + ": " + problem + " (" + std::to_string(clouds.size()) +
      " clouds from " + NameOf(cloud) + ", " + std::to_string(images.size()) + " images from " +
      NameOf(image) +
      "): give a cloud and its image the same number; or, if the first belong together, the second "
      "and so on, say so: frames_by: order under both drivers in the rig file, or --pair order; if "
      "a folder holds several files of one number, file_ending in the rig file says which");
}

/// Nothing if it is not there or empty, which is for its own driver to say.
std::optional<FrameFolder> FolderWithFrames(const FrameOptions& options,
                                            const std::vector<std::string>& endings) {
  if (options.folder.empty()) return {};
  try {
    return FrameFolder(options, endings);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// How many clouds have an image within the offset.
std::size_t NumPairs(const FrameFolder& clouds, const FrameFolder& images, double max_offset_s) {
  return static_cast<std::size_t>(
      std::count_if(clouds.files().begin(), clouds.files().end(), [&](const FrameFile& cloud) {
        return std::any_of(
            images.files().begin(), images.files().end(), [&](const FrameFile& image) {
              return 1e-6 * static_cast<double>(std::llabs(image.utime - cloud.utime)) <=
                     max_offset_s;
            });
      }));
}

/// As many of each, and every image's number as far from its cloud's: one of both counts from 0.
bool IsShifted(const FrameFolder& clouds, const FrameFolder& images) {
  if (clouds.naming() != FrameNaming::kNumbers || clouds.size() != images.size()) return false;
  const std::int64_t shift_us = images.files()[0].utime - clouds.files()[0].utime;
  if (shift_us == 0) return false;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    if (images.files()[i].utime - clouds.files()[i].utime != shift_us) return false;
  }
  return true;
}

}  // namespace

std::string PairingOf(const FrameFolder& clouds, const FrameFolder& images, double max_offset_s) {
  if (clouds.naming() != images.naming()) {
    Refuse(clouds,
           images,
           "the names of the clouds have " + ToString(clouds.naming()) + ", those of the images " +
               ToString(images.naming()));
  }
  const bool are_places = clouds.naming() == FrameNaming::kPlaces;
  if (are_places && clouds.size() != images.size()) {
    Refuse(clouds, images, "names without numbers pair by their order, but there are not as many");
  }
  if (IsShifted(clouds, images)) {
    Refuse(clouds, images, "the numbers of clouds and images are shifted against each other");
  }
  const std::size_t num_pairs = NumPairs(clouds, images, max_offset_s);
  if (num_pairs == 0) Refuse(clouds, images, "no cloud has the number or time of an image");
  return std::to_string(num_pairs) + " pairs, by " +
         (are_places ? "their order" : "the " + ToString(clouds.naming()) + " of their names");
}

std::string PairingOfDrivers(const Rig& rig) {
  const bool are_folders = rig.lidar_driver.source == LidarDriverOptions::Source::kFolder &&
                           rig.camera_driver.source == CameraDriverOptions::Source::kFolder;
  if (!are_folders) return "";
  const auto clouds = FolderWithFrames(rig.lidar_driver, kCloudEndings);
  const auto images = FolderWithFrames(rig.camera_driver, kImageEndings);
  if (!clouds || !images) return "";
  return PairingOf(*clouds, *images, rig.sample_collector.max_pair_offset_s);
}

void AnnouncePairing(const Rig& rig) {
  const std::string pairing = PairingOfDrivers(rig);
  if (!pairing.empty()) spdlog::info("clouds and images: {}", pairing);
}

}  // namespace voqcal
