#include "import/recorded_images.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "files/atomic_file.hpp"
#include "import/session_folders.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/log.hpp"
#include "messaging/session_scenes.hpp"
#include "rig/frame_folder.hpp"
#include "voqcal/image_t.hpp"

namespace voqcal {
namespace {

using TakeImage = std::function<void(const RecordedImage& image)>;

struct Counts {
  std::size_t num_taken = 0;
  std::size_t num_unreadable = 0;
};

cv::Mat Grey(const image_t& message) {
  cv::Mat image = FromMessage(message);
  if (image.channels() != 1) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  return image;
}

void Take(const image_t& message, double share, const TakeImage& take, Counts* counts) {
  RecordedImage image{{}, message.utime, share};
  try {
    image.grey = Grey(message);
  } catch (const std::runtime_error&) {
    ++counts->num_unreadable;
    return;
  }
  ++counts->num_taken;
  take(image);
}

// Which of `num` are taken so that at most `max` are: every so manieth.
std::size_t StepOf(std::size_t num, std::size_t max) {
  return std::max<std::size_t>(1, (num + max - 1) / max);
}

Counts TakeFolder(const std::filesystem::path& folder,
                  std::size_t max_images,
                  const TakeImage& take) {
  FrameOptions options;
  options.folder = FindSessionFolders(folder).images;
  const FrameFolder images(options, kImageEndings);
  const auto& files = images.files();
  Counts counts;
  for (std::size_t i = 0; i < files.size(); i += StepOf(files.size(), max_images)) {
    const std::string bytes = ReadWholeFile(files[i].path);
    const double share = static_cast<double>(i + 1) / static_cast<double>(files.size());
    image_t message;
    try {
      message = EncodedToMessage({bytes.begin(), bytes.end()}, files[i].utime, 0);
    } catch (const std::runtime_error&) {  // neither JPEG nor PNG
      ++counts.num_unreadable;
      continue;
    }
    Take(message, share, take, &counts);
  }
  return counts;
}

// The next event, or nothing at the end; what came before a cut is good.
std::optional<LogEvent> NextWhole(LogReader* reader) {
  try {
    return reader->Next();
  } catch (const TruncatedLogError&) {
    return {};
  }
}

std::size_t CountImages(const std::filesystem::path& log, const std::set<std::string>& channels) {
  std::size_t num = 0;
  LogReader reader(log);
  while (const auto event = NextWhole(&reader)) num += channels.count(event->channel);
  return num;
}

Counts TakeLog(const std::filesystem::path& log,
               const std::set<std::string>& channels,
               std::size_t max_images,
               const TakeImage& take) {
  const std::size_t step = StepOf(CountImages(log, channels), max_images);
  Counts counts;
  std::size_t place = 0;
  LogReader reader(log);
  while (const auto event = NextWhole(&reader)) {
    if (channels.count(event->channel) == 0 || place++ % step != 0) continue;
    image_t message;
    if (!DecodeMessage(event->bytes.data(), event->bytes.size(), &message).empty()) {
      ++counts.num_unreadable;
      continue;
    }
    const double share =
        static_cast<double>(reader.offset()) / static_cast<double>(reader.num_bytes());
    Take(message, share, take, &counts);
  }
  return counts;
}

}  // namespace

std::size_t ForEachImage(const std::filesystem::path& recording,
                         const std::string& channel,
                         std::size_t max_images,
                         const TakeImage& take) {
  const Counts counts = std::filesystem::is_directory(recording)
                            ? TakeFolder(recording, max_images, take)
                            : TakeLog(recording, {channel, kSceneImageChannel}, max_images, take);
  if (counts.num_taken == 0) {
    throw std::runtime_error(recording.string() + ": no image can be read" +
                             (std::filesystem::is_directory(recording) ? "" : " on " + channel));
  }
  return counts.num_unreadable;
}

}  // namespace voqcal
