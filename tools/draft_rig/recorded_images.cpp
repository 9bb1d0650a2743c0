#include "draft_rig/recorded_images.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "files/atomic_file.hpp"
#include "import/session_folders.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/log.hpp"
#include "rig/frame_folder.hpp"
#include "voqcal/image_t.hpp"

namespace voqcal {
namespace {

cv::Mat Grey(const image_t& message) {
  cv::Mat image = FromMessage(message);
  if (image.channels() != 1) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  return image;
}

// Which of `num` are taken so that at most `max` are: every so manieth.
std::size_t StepOf(std::size_t num, std::size_t max) {
  return std::max<std::size_t>(1, (num + max - 1) / max);
}

std::size_t TakeFolder(const std::filesystem::path& folder,
                       std::size_t max_images,
                       const std::function<void(const cv::Mat& grey)>& take) {
  FrameOptions options;
  options.folder = FindSessionFolders(folder).images;
  const FrameFolder images(options, kImageEndings);
  std::size_t num_taken = 0;
  for (std::size_t i = 0; i < images.size(); i += StepOf(images.size(), max_images)) {
    const std::string bytes = ReadWholeFile(images.files()[i].path);
    try {
      take(Grey(EncodedToMessage({bytes.begin(), bytes.end()}, 0, 0)));
      ++num_taken;
    } catch (const std::runtime_error&) {  // the import names it
    }
  }
  return num_taken;
}

std::size_t CountImages(const std::filesystem::path& log, const std::string& channel) {
  std::size_t num = 0;
  LogReader reader(log);
  while (const auto event = reader.Next()) num += event->channel == channel ? 1 : 0;
  return num;
}

std::size_t TakeLog(const std::filesystem::path& log,
                    const std::string& channel,
                    std::size_t max_images,
                    const std::function<void(const cv::Mat& grey)>& take) {
  const std::size_t step = StepOf(CountImages(log, channel), max_images);
  std::size_t num_taken = 0;
  std::size_t place = 0;
  LogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != channel || place++ % step != 0) continue;
    image_t message;
    if (!DecodeMessage(event->bytes.data(), event->bytes.size(), &message).empty()) continue;
    try {
      take(Grey(message));
      ++num_taken;
    } catch (const std::runtime_error&) {  // calibrate counts it
    }
  }
  return num_taken;
}

}  // namespace

void ForEachImage(const std::filesystem::path& recording,
                  const std::string& channel,
                  std::size_t max_images,
                  const std::function<void(const cv::Mat& grey)>& take) {
  const std::size_t num_taken = std::filesystem::is_directory(recording)
                                    ? TakeFolder(recording, max_images, take)
                                    : TakeLog(recording, channel, max_images, take);
  if (num_taken == 0) throw std::runtime_error(recording.string() + ": no image can be read");
}

}  // namespace voqcal
