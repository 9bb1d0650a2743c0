#include "modules/images/encoded_files.hpp"

#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <png.h>

namespace voqcal::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Without its segments DHT (marker C4), which lie before the one segment SOS (DA).
Bytes WithoutTables(const Bytes& jpeg) {
  Bytes kept(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  for (bool is_header = true; is_header;) {
    is_header = jpeg[at + 1] != 0xDA;
    const std::size_t end = is_header ? at + 2 + jpeg[at + 2] * 256U + jpeg[at + 3] : jpeg.size();
    if (jpeg[at + 1] != 0xC4) kept.insert(kept.end(), &jpeg[at], jpeg.data() + end);
    at = end;
  }
  return kept;
}

/// Random bytes are valid samples of any depth.
Bytes RandomBytes(std::size_t num_bytes) {
  cv::Mat noise(1, static_cast<int>(num_bytes), CV_8UC1);
  cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
  return {noise.begin<std::uint8_t>(), noise.end<std::uint8_t>()};
}

void WriteColours(png_structp png, png_infop info, const PngForm& form) {
  if (form.gamma > 0) png_set_gAMA(png, info, form.gamma);
  if (form.colour_type == PNG_COLOR_TYPE_PALETTE) {
    const Bytes noise = RandomBytes(3U << form.bit_depth);
    std::vector<png_color> palette;
    for (std::size_t i = 0; i < noise.size(); i += 3) {
      palette.push_back({noise[i], noise[i + 1], noise[i + 2]});
    }
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  }
  if (form.has_transparency) {
    const std::uint8_t alphas[] = {0, 100, 200};
    png_color_16 colour{};
    colour.gray = colour.red = colour.green = colour.blue = 1;
    png_set_tRNS(png, info, alphas, 3, &colour);
  }
}

void WriteText(png_structp png, png_infop info, std::size_t num_bytes) {
  std::string keyword = "Comment";
  std::string letters(num_bytes, 'a');
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_zTXt;
  text.key = keyword.data();
  text.text = letters.data();
  text.text_length = letters.size();
  png_set_text(png, info, &text, 1);
}

}  // namespace

cv::Mat Picture(int width_px, int height_px, int type) {
  cv::Mat picture(height_px, width_px, type);
  cv::RNG(7).fill(picture, cv::RNG::NORMAL, 128, 20);
  cv::circle(picture,
             {width_px / 2, height_px / 2},
             height_px / 3,
             cv::Scalar(250, 30, 90, 60),
             cv::FILLED);
  return picture;
}

cv::Mat DecodedByOpenCv(const std::vector<std::uint8_t>& bytes, int flags) {
  return cv::imdecode(bytes, flags | cv::IMREAD_IGNORE_ORIENTATION);
}

std::vector<std::uint8_t> JpegFile(int width_px, int height_px, const JpegForm& form) {
  cv::Mat picture = Picture(width_px, height_px, CV_8UC(form.num_channels));
  jpeg_error_mgr errors{};
  jpeg_compress_struct info{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libjpeg's
  jpeg_mem_dest(&info, &data, &size);
  info.image_width = static_cast<JDIMENSION>(width_px);
  info.image_height = static_cast<JDIMENSION>(height_px);
  info.input_components = form.num_channels;
  info.in_color_space = form.num_channels == 1   ? JCS_GRAYSCALE
                        : form.num_channels == 3 ? JCS_EXT_BGR
                                                 : JCS_CMYK;
  jpeg_set_defaults(&info);
  if (form.num_channels == 3) {
    info.comp_info[0].h_samp_factor = form.luma_horizontal;
    info.comp_info[0].v_samp_factor = form.luma_vertical;
  }
  if (form.is_progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  for (int row = 0; row < height_px; ++row) {
    JSAMPROW pixels = picture.ptr(row);
    jpeg_write_scanlines(&info, &pixels, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const Bytes jpeg(data, data + size);
  std::free(data);
  return form.has_tables ? jpeg : WithoutTables(jpeg);
}

std::vector<std::uint8_t> PngFile(int width_px, int height_px, const PngForm& form) {
  Bytes file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto write = [](png_structp to, png_bytep bytes, std::size_t num_bytes) {
    auto* all = static_cast<Bytes*>(png_get_io_ptr(to));
    all->insert(all->end(), bytes, bytes + num_bytes);
  };
  png_set_write_fn(png, &file, write, nullptr);
  png_set_IHDR(png,
               info,
               static_cast<png_uint_32>(width_px),
               static_cast<png_uint_32>(height_px),
               form.bit_depth,
               form.colour_type,
               form.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  WriteColours(png, info, form);
  if (form.num_text_bytes > 0) WriteText(png, info, form.num_text_bytes);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  Bytes noise = RandomBytes(row_bytes * static_cast<std::size_t>(height_px));
  std::vector<png_bytep> rows;
  for (int row = 0; row < height_px; ++row) rows.push_back(&noise[row * row_bytes]);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace voqcal::test
