#pragma once

#include <filesystem>
#include <functional>

#include <opencv2/core/mat.hpp>

namespace voqcal {

/// Hands every image of a recording to `take`, grey: of a folder of images and clouds, or of an LCM
/// log those on `channel`, but at most `max_images`, spread over it. Images that cannot be decoded
/// are left out.
/// @throws std::runtime_error naming the recording if there is no image in it.
void ForEachImage(const std::filesystem::path& recording,
                  const std::string& channel,
                  std::size_t max_images,
                  const std::function<void(const cv::Mat& grey)>& take);

}  // namespace voqcal
