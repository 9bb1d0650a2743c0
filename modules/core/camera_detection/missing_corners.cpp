#include "core/camera_detection/missing_corners.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr int kWays[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

class Grid {
 public:
  explicit Grid(const CornerGrid& grid) : grid_(grid) {}

  std::optional<cv::Point2f> At(int i, int j) const {
    if (i < 0 || j < 0 || i >= grid_.size.width || j >= grid_.size.height) return {};
    const cv::Point2f p = grid_.corners[j * grid_.size.width + i];
    if (!std::isfinite(p.x)) return {};
    return p;
  }

  // Where a missing corner must be: between two neighbours, else beyond two of a line; the mean of
  // both lines.
  std::optional<cv::Point2f> Predicted(int i, int j) const {
    cv::Point2f sum(0, 0);
    int num = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const auto before = At(i - kWays[axis][0], j - kWays[axis][1]);
      const auto after = At(i + kWays[axis][0], j + kWays[axis][1]);
      if (!before || !after) continue;
      sum += (*before + *after) / 2;
      ++num;
    }
    for (int way = 0; way < 4 && num == 0; ++way) {
      const auto near = At(i + kWays[way][0], j + kWays[way][1]);
      const auto far = At(i + 2 * kWays[way][0], j + 2 * kWays[way][1]);
      if (near && far) sum = 2 * *near - *far;
      num = near && far ? 1 : 0;
    }
    if (num == 0) return {};
    return sum / num;
  }

  // From a corner to its next one along an axis (0: x, 1: y), by itself or by those beside it.
  std::optional<cv::Point2f> Step(int i, int j, int axis) const {
    const int di = kWays[axis][0];
    const int dj = kWays[axis][1];
    for (int side : {0, 1, -1, 2, -2}) {
      const int a = i + side * dj;
      const int b = j + side * di;
      const auto here = At(a, b);
      const auto after = At(a + di, b + dj);
      if (here && after) return *after - *here;
      const auto before = At(a - di, b - dj);
      if (here && before) return *here - *before;
    }
    return {};
  }

 private:
  const CornerGrid& grid_;
};

// The contrast of a corner, of the sign that makes it the same all over the grid; 0 if unknown.
double ContrastAt(const cv::Mat& grey, const Grid& grid, int i, int j, const cv::Point2f& at_px) {
  const auto step_x = grid.Step(i, j, 0);
  const auto step_y = grid.Step(i, j, 1);
  if (!step_x || !step_y) return 0;
  return ((i + j) % 2 == 0 ? 1 : -1) * QuarterContrast(grey, at_px, *step_x, *step_y);
}

double MedianContrast(const cv::Mat& grey, const CornerGrid& corners) {
  const Grid grid(corners);
  std::vector<double> contrasts;
  for (int j = 0; j < corners.size.height; ++j) {
    for (int i = 0; i < corners.size.width; ++i) {
      const auto at_px = grid.At(i, j);
      if (at_px) contrasts.push_back(ContrastAt(grey, grid, i, j, *at_px));
    }
  }
  return Median(std::move(contrasts));
}

// The corner near where the grid puts it, if its squares look like the grid's.
std::optional<cv::Point2f> Confirmed(
    const cv::Mat& grey, const Grid& grid, int i, int j, double median_contrast) {
  constexpr double kMaxShiftSteps = 0.25;
  constexpr double kMinContrastShare = 0.15;  // in shade of a fifth of the light, and noise
  const auto predicted = grid.Predicted(i, j);
  const auto step_x = grid.Step(i, j, 0);
  const auto step_y = grid.Step(i, j, 1);
  if (!predicted || !step_x || !step_y) return {};
  const double step_px = std::min(cv::norm(*step_x), cv::norm(*step_y));
  std::vector<cv::Point2f> corner{*predicted};
  const int half_window_px = std::clamp(static_cast<int>(0.35 * step_px), 2, 10);
  try {
    cv::cornerSubPix(grey,
                     corner,
                     {half_window_px, half_window_px},
                     {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3});
  } catch (const cv::Exception&) {
    return {};  // too near to the image's border
  }
  if (cv::norm(corner[0] - *predicted) > kMaxShiftSteps * step_px) return {};
  const double contrast = ContrastAt(grey, grid, i, j, corner[0]);
  if (contrast / median_contrast < kMinContrastShare) return {};
  // Nearer by half as well, lest something small hides it.
  if (QuarterContrast(grey, corner[0], *step_x / 2, *step_y / 2) == 0) return {};
  return corner[0];
}

}  // namespace

double QuarterContrast(const cv::Mat& grey,
                       const cv::Point2f& corner_px,
                       const cv::Point2f& step_x_px,
                       const cv::Point2f& step_y_px) {
  const cv::Point2f same = (step_x_px + step_y_px) / 4;
  const cv::Point2f other = (step_x_px - step_y_px) / 4;
  std::array<double, 4> levels;
  const std::array<cv::Point2f, 4> points{
      corner_px + same, corner_px - same, corner_px + other, corner_px - other};
  for (std::size_t n = 0; n < points.size(); ++n) {
    const cv::Point pixel(cvRound(points[n].x), cvRound(points[n].y));
    if (!cv::Rect({0, 0}, grey.size()).contains(pixel)) return 0;
    levels[n] = grey.at<std::uint8_t>(pixel);
  }
  const bool is_brighter = std::min(levels[0], levels[1]) > std::max(levels[2], levels[3]);
  const bool is_darker = std::max(levels[0], levels[1]) < std::min(levels[2], levels[3]);
  if (!is_brighter && !is_darker) return 0;
  return (levels[0] + levels[1] - levels[2] - levels[3]) / 2;
}

std::vector<cv::Point2f> PlacesOfMissing(const CornerGrid& grid) {
  const Grid known(grid);
  std::vector<cv::Point2f> places;
  for (int j = 0; j < grid.size.height; ++j) {
    for (int i = 0; i < grid.size.width; ++i) {
      const auto place = known.At(i, j) ? std::nullopt : known.Predicted(i, j);
      if (place) places.push_back(*place);
    }
  }
  return places;
}

CornerGrid WithMissingCorners(const cv::Mat& grey, const CornerGrid& grid) {
  CornerGrid filled = grid;
  const double median_contrast = MedianContrast(grey, grid);
  if (median_contrast == 0) return grid;
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    const Grid now(filled);
    for (int j = 0; j < grid.size.height; ++j) {
      for (int i = 0; i < grid.size.width; ++i) {
        if (now.At(i, j)) continue;
        const auto corner = Confirmed(grey, now, i, j, median_contrast);
        if (!corner) continue;
        filled.corners[j * grid.size.width + i] = *corner;
        ++filled.num_found;
        has_grown = true;
      }
    }
  }
  return filled;
}

}  // namespace voqcal
