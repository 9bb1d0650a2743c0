#include "images/png.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include <png.h>

#include "images/c_library.hpp"
#include "images/new_image.hpp"

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

class Reader {
 public:
  explicit Reader(const Bytes& bytes) : next_(bytes.data()), num_left_(bytes.size()) {
    const auto fail = [](png_structp from, png_const_charp cause) {
      static_cast<CFailure*>(png_get_error_ptr(from))->Jump(cause);
    };
    const auto ignore = [](png_structp, png_const_charp) {};
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure_, fail, ignore);
    info = png_create_info_struct(png);  // null for null
    if (info == nullptr) {
      png_destroy_read_struct(&png, nullptr, nullptr);  // no destructor runs
      throw std::runtime_error("libpng cannot be used");
    }
    // Texts, profiles and the like, a thousand of up to 8 MB each, are not even unpacked.
    Call([this] { png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1); });
    png_set_read_fn(png, this, [](png_structp from, png_bytep to, std::size_t num_bytes) {
      static_cast<Reader*>(png_get_io_ptr(from))->Read(to, num_bytes);
    });
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  template <typename Steps>
  void Call(const Steps& steps) {
    CallC(&failure_, steps);
  }

  png_structp png = nullptr;
  png_infop info = nullptr;

 private:
  void Read(std::uint8_t* to, std::size_t num_bytes) {
    if (num_bytes > num_left_) failure_.Jump("it is cut off");
    std::copy(next_, next_ + num_bytes, to);
    next_ += num_bytes;
    num_left_ -= num_bytes;
  }

  CFailure failure_;
  const std::uint8_t* next_;
  std::size_t num_left_;
};

/// Asks for rows of 8-bit GRAY or BGR, whatever the file has.
void Transform(png_structp png, png_infop info, bool is_gray) {
  const int colour = png_get_color_type(png, info);
  png_set_strip_16(png);
  png_set_strip_alpha(png);
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (colour == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
  if (colour == PNG_COLOR_TYPE_GRAY_ALPHA) png_set_gray_to_rgb(png);
  if (!is_gray) png_set_bgr(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

}  // namespace

cv::Mat DecodePng(const std::vector<std::uint8_t>& bytes) {
  Reader reader(bytes);
  reader.Call([&] { png_read_info(reader.png, reader.info); });
  const std::int64_t width_px = png_get_image_width(reader.png, reader.info);
  const std::int64_t height_px = png_get_image_height(reader.png, reader.info);
  RequireFewPixels(width_px, height_px, kMaxImagePixels);
  const bool is_gray = png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_GRAY;
  cv::Mat image = NewImage(width_px, height_px, is_gray ? CV_8UC1 : CV_8UC3);
  std::vector<png_bytep> rows;
  for (int row = 0; row < image.rows; ++row) rows.push_back(image.ptr(row));
  reader.Call([&] { Transform(reader.png, reader.info, is_gray); });
  if (png_get_rowbytes(reader.png, reader.info) != image.step) {
    throw std::logic_error("libpng's rows are none of 8-bit GRAY or BGR");
  }
  reader.Call([&] {
    png_read_image(reader.png, rows.data());
    png_read_end(reader.png, nullptr);
  });
  return image;
}

}  // namespace voqcal
