#include "images/jpeg.hpp"

#include <cstddef>
#include <new>
#include <stdexcept>
#include <utility>

// It uses FILE and size_t without including them.
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>

#include "images/c_library.hpp"
#include "images/new_image.hpp"

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// libjpeg's error manager comes first, so that a pointer to it is one to the whole.
struct JpegErrors {
  jpeg_error_mgr manager;
  CFailure failure;

  JpegErrors() {
    jpeg_std_error(&manager);
    manager.error_exit = [](j_common_ptr common) {
      std::array<char, JMSG_LENGTH_MAX> text{};
      common->err->format_message(common, text.data());
      reinterpret_cast<JpegErrors*>(common->err)->failure.Jump(text.data());
    };
    manager.emit_message = [](j_common_ptr, int) {};
  }
};

template <typename Info>
[[noreturn]] void Fail(const Info* info, const char* cause) {
  reinterpret_cast<JpegErrors*>(info->err)->failure.Jump(cause);
}

/// libjpeg's own goes on with an end marker, and the missing rest is grey.
boolean FailAtEnd(j_decompress_ptr info) { Fail(info, "it is cut off"); }

/// libjpeg only warns of an end marker before the image's end; the rest would be grey there too.
void FailAtEarlyEnd(j_common_ptr common, int /*level*/) {
  const auto* info = reinterpret_cast<j_decompress_ptr>(common);
  if (info->err->msg_code == JWRN_HIT_MARKER && info->unread_marker == JPEG_EOI) {
    Fail(info, "it is cut off");
  }
}

/// Each scan of a progressive JPEG takes the time of a whole image, and may be a few bytes.
void FailAtManyScans(j_common_ptr common) {
  constexpr int kMaxScans = 200;  // encoders make some ten
  const auto* info = reinterpret_cast<j_decompress_ptr>(common);
  if (info->input_scan_number > kMaxScans) Fail(info, "it has too many scans");
}

class Decompressor {
 public:
  Decompressor() {
    info.err = &errors_.manager;
    CallC(&errors_.failure, [this] { jpeg_create_decompress(&info); });
    errors_.manager.emit_message = FailAtEarlyEnd;
    progress_.progress_monitor = FailAtManyScans;
    info.progress = &progress_;
  }
  ~Decompressor() { jpeg_destroy_decompress(&info); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  template <typename Steps>
  void Call(const Steps& steps) {
    CallC(&errors_.failure, steps);
  }

  jpeg_decompress_struct info{};

 private:
  JpegErrors errors_;
  jpeg_progress_mgr progress_{};
};

/// Bytes that grow as libjpeg fills them. The manager comes first, as in JpegErrors.
struct GrowingBytes {
  jpeg_destination_mgr manager{};
  Bytes bytes;

  GrowingBytes() {
    manager.init_destination = [](j_compress_ptr info) { Grow(info, 1U << 16U); };
    manager.empty_output_buffer = [](j_compress_ptr info) -> boolean {
      Grow(info, Of(info)->bytes.size());
      return TRUE;
    };
    manager.term_destination = [](j_compress_ptr info) {
      Of(info)->bytes.resize(Of(info)->bytes.size() - info->dest->free_in_buffer);
    };
  }

 private:
  static GrowingBytes* Of(j_compress_ptr info) {
    return reinterpret_cast<GrowingBytes*>(info->dest);
  }

  /// No exception may pass through libjpeg, and no jump leave a handler of one.
  static void Grow(j_compress_ptr info, std::size_t num_more) {
    if (!Of(info)->HasGrown(num_more)) Fail(info, "no memory for it");
  }

  bool HasGrown(std::size_t num_more) {
    const std::size_t num_used = bytes.size();
    try {
      bytes.resize(num_used + num_more);
    } catch (const std::bad_alloc&) {
      return false;
    }
    manager.next_output_byte = bytes.data() + num_used;
    manager.free_in_buffer = num_more;
    return true;
  }
};

class Compressor {
 public:
  Compressor() {
    info.err = &errors_.manager;
    CallC(&errors_.failure, [this] { jpeg_create_compress(&info); });
    info.dest = &destination_.manager;
  }
  ~Compressor() { jpeg_destroy_compress(&info); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  template <typename Steps>
  void Call(const Steps& steps) {
    CallC(&errors_.failure, steps);
  }

  Bytes TakeBytes() { return std::move(destination_.bytes); }

  jpeg_compress_struct info{};

 private:
  JpegErrors errors_;
  GrowingBytes destination_;
};

J_COLOR_SPACE ColourSpaceOf(const cv::Mat& image) {
  switch (image.type()) {
    case CV_8UC1:
      return JCS_GRAYSCALE;
    case CV_8UC3:
      return JCS_EXT_BGR;
    case CV_8UC4:
      return JCS_EXT_BGRX;
    default:
      throw std::invalid_argument("image to encode: must be 8-bit with 1, 3 or 4 channels");
  }
}

cv::Mat Decode(const Bytes& bytes, int reduction, bool is_grey_wanted) {
  Decompressor decompressor;
  jpeg_decompress_struct& info = decompressor.info;
  decompressor.Call([&] {
    jpeg_mem_src(&info, bytes.data(), bytes.size());
    info.src->fill_input_buffer = FailAtEnd;
    jpeg_read_header(&info, TRUE);
  });
  // Before the first row of a progressive one there are all coefficients, two bytes each.
  RequireFewPixels(info.image_width,
                   info.image_height,
                   jpeg_has_multiple_scans(&info) ? kMaxImagePixels / 2 : kMaxImagePixels);
  if (info.num_components == 4) throw std::runtime_error("it is a CMYK one");
  const bool is_gray = is_grey_wanted || info.num_components == 1;
  info.out_color_space = is_gray ? JCS_GRAYSCALE : JCS_EXT_BGR;
  info.scale_num = 1;
  info.scale_denom = static_cast<unsigned>(reduction);
  decompressor.Call([&] { jpeg_start_decompress(&info); });
  cv::Mat image = NewImage(info.output_width, info.output_height, is_gray ? CV_8UC1 : CV_8UC3);
  decompressor.Call([&] {
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = image.ptr(static_cast<int>(info.output_scanline));
      jpeg_read_scanlines(&info, &row, 1);
    }
  });
  return image;
}

}  // namespace

cv::Mat DecodeJpeg(const Bytes& bytes, int reduction) { return Decode(bytes, reduction, false); }

cv::Mat DecodeJpegInGrey(const Bytes& bytes) { return Decode(bytes, 1, true); }

std::vector<std::uint8_t> EncodeJpeg(const cv::Mat& image, int quality) {
  if (image.empty()) throw std::invalid_argument("image to encode: is empty");
  Compressor compressor;
  jpeg_compress_struct& info = compressor.info;
  info.in_color_space = ColourSpaceOf(image);
  info.input_components = image.channels();
  info.image_width = static_cast<JDIMENSION>(image.cols);
  info.image_height = static_cast<JDIMENSION>(image.rows);
  compressor.Call([&] {
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
      JSAMPROW row = const_cast<JSAMPROW>(image.ptr(static_cast<int>(info.next_scanline)));
      jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
  });
  return compressor.TakeBytes();
}

}  // namespace voqcal
