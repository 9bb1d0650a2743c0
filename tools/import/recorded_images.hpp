#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace voqcal {

/// An image of a recording.
struct RecordedImage {
  cv::Mat grey;
  std::int64_t utime = 0;  ///< Microseconds; of a folder's, by its name.
  double share = 0.0;      ///< Of the recording that has been read with it.
};

/// Hands every image of a recording to `take`: of a folder of images and clouds, or of an LCM log
/// those on `channel` and, in a session's samples.lcm, those of its samples; but at most
/// `max_images`, spread over it.
/// @return how many images could not be decoded.
/// @throws std::runtime_error naming the recording if there is no image in it.
std::size_t ForEachImage(const std::filesystem::path& recording,
                         const std::string& channel,
                         std::size_t max_images,
                         const std::function<void(const RecordedImage& image)>& take);

}  // namespace voqcal
