// Speed of reading and writing image files beside OpenCV's, on the same 1920 x 1208 pixels and
// bytes.

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "images/jpeg.hpp"
#include "images/png.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kQuality = 90;

// A board 2 m ahead, in colour, with a camera's noise.
const cv::Mat& Image() {
  static const cv::Mat image = [] {
    Eigen::Isometry3d T_camera_board(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
    T_camera_board.translation().z() = 2;
    const cv::Mat board = test::RenderBoard(test::TestCamera(), test::TestBoard(), T_camera_board);
    cv::Mat colours;
    cv::merge(std::vector<cv::Mat>(3, board), colours);
    cv::Mat noise(colours.size(), CV_16SC3);
    cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, 2.0);
    cv::add(colours, noise, colours, cv::noArray(), CV_8U);
    return colours;
  }();
  return image;
}

Bytes File(const char* extension) {
  Bytes bytes;
  cv::imencode(extension, Image(), bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return bytes;
}

void DecodeJpegAt(benchmark::State& state) {
  const Bytes jpeg = File(".jpg");
  for (auto _ : state) {
    benchmark::DoNotOptimize(DecodeJpeg(jpeg, static_cast<int>(state.range(0))));
  }
}

void DecodeJpegGrey(benchmark::State& state) {
  const Bytes jpeg = File(".jpg");
  for (auto _ : state) benchmark::DoNotOptimize(DecodeJpegInGrey(jpeg));
}

void ImdecodeJpegAt(benchmark::State& state) {
  const Bytes jpeg = File(".jpg");
  const int flags = state.range(0) == 1 ? cv::IMREAD_COLOR : cv::IMREAD_REDUCED_COLOR_2;
  for (auto _ : state) benchmark::DoNotOptimize(cv::imdecode(jpeg, flags));
}

void DecodePngWhole(benchmark::State& state) {
  const Bytes png = File(".png");
  for (auto _ : state) benchmark::DoNotOptimize(DecodePng(png));
}

void ImdecodePngWhole(benchmark::State& state) {
  const Bytes png = File(".png");
  for (auto _ : state) benchmark::DoNotOptimize(cv::imdecode(png, cv::IMREAD_COLOR));
}

void EncodeJpegWhole(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(EncodeJpeg(Image(), kQuality));
}

void ImencodeJpegWhole(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(File(".jpg"));
}

BENCHMARK(DecodeJpegAt)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(DecodeJpegGrey)->Unit(benchmark::kMillisecond);
BENCHMARK(ImdecodeJpegAt)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(DecodePngWhole)->Unit(benchmark::kMillisecond);
BENCHMARK(ImdecodePngWhole)->Unit(benchmark::kMillisecond);
BENCHMARK(EncodeJpegWhole)->Unit(benchmark::kMillisecond);
BENCHMARK(ImencodeJpegWhole)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
