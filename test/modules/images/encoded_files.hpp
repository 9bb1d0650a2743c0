#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace voqcal::test {

/// An image with edges and noise, which show every difference of decoders; the same each time.
/// @param type  8 bits with any number of channels.
cv::Mat Picture(int width_px, int height_px, int type);

/// What OpenCV reads; empty if it cannot.
cv::Mat DecodedByOpenCv(const std::vector<std::uint8_t>& bytes, int flags);

struct JpegForm {
  std::string name;
  int num_channels = 3;     ///< 1: grey, 3: BGR, 4: CMYK.
  int luma_horizontal = 2;  ///< Of colours' sampling: 2, 2 is 4:2:0; 2, 1 is 4:2:2; 1, 1 is 4:4:4.
  int luma_vertical = 2;
  bool is_progressive = false;
  bool has_tables = true;  ///< Cameras' MJPEG may leave the Huffman tables out.
};

std::vector<std::uint8_t> JpegFile(int width_px, int height_px, const JpegForm& form);

struct PngForm {
  std::string name;
  int colour_type = 0;  ///< PNG_COLOR_TYPE_...
  int bit_depth = 8;
  bool is_interlaced = false;
  bool has_transparency = false;   ///< Chunk tRNS.
  double gamma = 0;                ///< Chunk gAMA, unless 0.
  std::size_t num_text_bytes = 0;  ///< Chunk zTXt, unless 0.
};

std::vector<std::uint8_t> PngFile(int width_px, int height_px, const PngForm& form);

}  // namespace voqcal::test
