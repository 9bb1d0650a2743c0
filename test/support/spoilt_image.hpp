#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/simulation/keyed_noise.hpp"

namespace voqcal::test {

// What befalls images of boards: each gives another image of the same size, 8-bit, 1 channel.

inline cv::Mat Blurred(const cv::Mat& image, double sigma_px) {
  if (sigma_px <= 0) return image;
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {}, sigma_px);
  return blurred;
}

/// The camera or the board moved by `length_px` along a row during the exposure.
inline cv::Mat MovedAlongRows(const cv::Mat& image, int length_px) {
  cv::Mat moved;
  cv::blur(image, moved, {length_px, 1});
  return moved;
}

/// Contrast and mid level: level' = 128 + share (level - 128) + lift.
inline cv::Mat Paled(const cv::Mat& image, double share, double lift) {
  cv::Mat paled;
  image.convertTo(paled, CV_8U, share, 128 * (1 - share) + lift);
  return paled;
}

/// A light's reflection: grey levels added, most (`strength`) at the centre, a Gaussian around it.
inline cv::Mat WithGlare(const cv::Mat& image,
                         const Eigen::Vector2d& centre_px,
                         double sigma_px,
                         double strength) {
  cv::Mat glared = image.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double distance = (Eigen::Vector2d(x, y) - centre_px).norm() / sigma_px;
      const double level =
          image.at<std::uint8_t>(y, x) + strength * std::exp(-distance * distance / 2);
      glared.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(level);
    }
  }
  return glared;
}

/// A shadow over all that lies on the far side of a line: its light is multiplied by `light`, over
/// a penumbra of `width_px`.
inline cv::Mat WithShadow(const cv::Mat& image,
                          const Eigen::Vector2d& on_line_px,
                          const Eigen::Vector2d& direction,
                          double light,
                          double width_px) {
  cv::Mat shaded = image.clone();
  const Eigen::Vector2d normal = Eigen::Vector2d(-direction.y(), direction.x()).normalized();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double depth = normal.dot(Eigen::Vector2d(x, y) - on_line_px) / width_px;
      const double share = 1 / (1 + std::exp(-4 * depth));
      const double level = image.at<std::uint8_t>(y, x) * (1 - share * (1 - light));
      shaded.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(level);
    }
  }
  return shaded;
}

/// Light that falls off evenly from left to right, to `light` of it.
inline cv::Mat UnevenlyLit(const cv::Mat& image, double light) {
  cv::Mat lit = image.clone();
  for (int x = 0; x < image.cols; ++x) {
    lit.col(x) *= 1 - (1 - light) * x / image.cols;
  }
  return lit;
}

/// Normal noise of each pixel, in grey levels.
inline cv::Mat WithNoise(const cv::Mat& image, double sigma, std::uint32_t seed) {
  const KeyedNoise noise(seed, NoiseUse::kPixelTable);
  cv::Mat noisy = image.clone();
  std::uint64_t index = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; x += 2) {
      const auto [a, b] = noise.Normals(index++);
      std::uint8_t* pixel = noisy.ptr(y) + x;
      pixel[0] = cv::saturate_cast<std::uint8_t>(pixel[0] + sigma * a);
      if (x + 1 < image.cols) pixel[1] = cv::saturate_cast<std::uint8_t>(pixel[1] + sigma * b);
    }
  }
  return noisy;
}

}  // namespace voqcal::test
