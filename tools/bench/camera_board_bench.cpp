// Speed of the camera board detector beside OpenCV's finder, both on the same 1920 x 1208 images.

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kNoise = 2.0;  // grey levels

// The board 2 m or 5 m ahead, slanted; with the real session's camera.
const cv::Mat& ImageOfBoard(int distance_m) {
  const auto render = [](double metres) {
    Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
    T_camera_board.linear() = ExpSO3({0.3, -0.4, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, 0.7});
    T_camera_board.translation() << 0.1, 0.0, metres;
    cv::Mat image = test::RenderBoard(test::TestCamera(), test::TestBoard(), T_camera_board);
    cv::Mat noise(image.size(), CV_16S);
    cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0, kNoise);
    cv::add(image, noise, image, cv::noArray(), CV_8U);
    return image;
  };
  static const cv::Mat near = render(2);
  static const cv::Mat far = render(5);
  return distance_m == 2 ? near : far;
}

// The image of 2 m with one corner covered: everything of a board but the board.
cv::Mat ImageWithoutBoard() {
  cv::Mat image = ImageOfBoard(2).clone();
  cv::circle(image, {image.cols / 2, image.rows / 2}, 40, cv::Scalar(128), cv::FILLED);
  return image;
}

cv::Mat BlankImage() {
  const cv::Mat& board = ImageOfBoard(2);
  return cv::Mat(board.size(), board.type(), cv::Scalar(110));
}

void Detect(benchmark::State& state, const cv::Mat& image) {
  cv::setNumThreads(1);
  bool is_found = false;
  for (auto _ : state) {
    is_found = DetectCameraBoard(image, test::TestCamera(), test::TestBoard(), CameraBoardOptions{})
                   .has_value();
    benchmark::DoNotOptimize(is_found);
  }
  state.SetLabel(is_found ? "found" : "not found");
}

void OpenCv(benchmark::State& state, const cv::Mat& image) {
  cv::setNumThreads(1);
  const cv::Size pattern(test::TestBoard().num_corners_x, test::TestBoard().num_corners_y);
  bool is_found = false;
  for (auto _ : state) {
    std::vector<cv::Point2f> corners_px;
    is_found = cv::findChessboardCornersSB(image, pattern, corners_px);
    benchmark::DoNotOptimize(is_found);
  }
  state.SetLabel(is_found ? "found" : "not found");
}

void DetectCameraBoardAt(benchmark::State& state) {
  Detect(state, ImageOfBoard(static_cast<int>(state.range(0))));
}
void FindChessboardCornersSBAt(benchmark::State& state) {
  OpenCv(state, ImageOfBoard(static_cast<int>(state.range(0))));
}
BENCHMARK(DetectCameraBoardAt)->Arg(2)->Arg(5)->Unit(benchmark::kMillisecond);
BENCHMARK(FindChessboardCornersSBAt)->Arg(2)->Arg(5)->Unit(benchmark::kMillisecond);

void DetectCameraBoardCovered(benchmark::State& state) { Detect(state, ImageWithoutBoard()); }
void FindChessboardCornersSBCovered(benchmark::State& state) { OpenCv(state, ImageWithoutBoard()); }
BENCHMARK(DetectCameraBoardCovered)->Unit(benchmark::kMillisecond);
BENCHMARK(FindChessboardCornersSBCovered)->Unit(benchmark::kMillisecond);

void DetectCameraBoardBlank(benchmark::State& state) { Detect(state, BlankImage()); }
void FindChessboardCornersSBBlank(benchmark::State& state) { OpenCv(state, BlankImage()); }
BENCHMARK(DetectCameraBoardBlank)->Unit(benchmark::kMillisecond);
BENCHMARK(FindChessboardCornersSBBlank)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
