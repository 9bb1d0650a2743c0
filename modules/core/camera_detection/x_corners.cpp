#include "core/camera_detection/x_corners.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

// The circle on which a corner's quarters are told apart: 16 pixels, 3 px away, from pixel x
// towards pixel y. Larger circles leave the squares of small boards, smaller ones see only blur.
constexpr int kRadiusPx = 3;
constexpr int kNumRing = 16;
constexpr int kRing[kNumRing][2] = {{3, 0},
                                    {3, 1},
                                    {2, 2},
                                    {1, 3},
                                    {0, 3},
                                    {-1, 3},
                                    {-2, 2},
                                    {-3, 1},
                                    {-3, 0},
                                    {-3, -1},
                                    {-2, -2},
                                    {-1, -3},
                                    {0, -3},
                                    {1, -3},
                                    {2, -2},
                                    {3, -1}};

// Grey levels are kept 16-fold, the sum of the smoothing kernel: fractions survive in integers.
constexpr float kScale = 16.0F;
constexpr float kMinContrast = 8.0F;    // grey levels; less is noise of 2 levels
constexpr float kMaxAsymmetry = 0.25F;  // of the contrast; noise alone has about 0.35
// Least sqrt(-det) of the Hessian, grey levels per px^2. An ideal corner of contrast C under a blur
// of s px has 0.32 C / s^2: 3 lets a contrast of 30 through up to 1.8 px of blur; blurrier ones are
// found on a smaller level of the pyramid.
constexpr float kMinSaddle = 3.0F;

cv::Mat Smoothed(const cv::Mat& grey) {
  const cv::Mat kernel = (cv::Mat_<float>(3, 1) << 1, 2, 1);
  cv::Mat smooth;
  cv::sepFilter2D(grey, smooth, CV_16S, kernel, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
  return smooth;
}

// First and second derivatives of the smoothed image at a pixel, scaled levels per px and px^2.
struct Derivatives {
  float x, y, xx, yy, xy;
};

Derivatives DerivativesAt(const cv::Mat& smooth, int x, int y) {
  const auto at = [&](int dx, int dy) {
    return static_cast<float>(smooth.at<short>(y + dy, x + dx));
  };
  return {(at(1, 0) - at(-1, 0)) / 2,
          (at(0, 1) - at(0, -1)) / 2,
          at(1, 0) - 2 * at(0, 0) + at(-1, 0),
          at(0, 1) - 2 * at(0, 0) + at(0, -1),
          (at(1, 1) - at(-1, 1) - at(1, -1) + at(-1, -1)) / 4};
}

// -det of the Hessian along row y: positive at saddles. The loop is what the compiler vectorises.
void SaddleRow(const cv::Mat& smooth, int y, std::vector<float>* saddle) {
  const short* above = smooth.ptr<short>(y - 1);
  const short* here = smooth.ptr<short>(y);
  const short* below = smooth.ptr<short>(y + 1);
  float* out = saddle->data();
  for (int x = 1; x < smooth.cols - 1; ++x) {
    const auto xx = static_cast<float>(here[x + 1] - 2 * here[x] + here[x - 1]);
    const auto yy = static_cast<float>(below[x] - 2 * here[x] + above[x]);
    const auto xy =
        0.25F * static_cast<float>(below[x + 1] - below[x - 1] - above[x + 1] + above[x - 1]);
    out[x] = xy * xy - xx * yy;
  }
}

// Where the smoothed surface is level near pixel (x, y): the corner, if it is one.
std::optional<cv::Point2f> SaddlePoint(const cv::Mat& smooth, int x, int y) {
  // Newton's step is too long where the image is sharp: 1 px for an upright corner between pixels.
  constexpr float kMaxStepPx = 1.5F;
  constexpr float kMaxShiftPx = 0.5F;  // farther away another pixel is the maximum
  const Derivatives d = DerivativesAt(smooth, x, y);
  const float det = d.xx * d.yy - d.xy * d.xy;
  const float dx = -(d.yy * d.x - d.xy * d.y) / det;
  const float dy = -(d.xx * d.y - d.xy * d.x) / det;
  if (!(std::abs(dx) <= kMaxStepPx && std::abs(dy) <= kMaxStepPx)) return {};
  return cv::Point2f(static_cast<float>(x) + std::clamp(dx, -kMaxShiftPx, kMaxShiftPx),
                     static_cast<float>(y) + std::clamp(dy, -kMaxShiftPx, kMaxShiftPx));
}

// Mean difference of opposite pixels of the circle.
float Asymmetry(const std::array<float, kNumRing>& ring) {
  float sum = 0;
  for (int k = 0; k < kNumRing / 2; ++k) sum += std::abs(ring[k] - ring[k + kNumRing / 2]);
  return sum / (kNumRing / 2);
}

// Where the circle changes shade, as points on the unit circle: rising to bright, falling to dark,
// rising, falling. Nothing unless it does so exactly four times.
std::optional<std::array<cv::Point2f, 4>> ShadeChanges(const std::array<float, kNumRing>& ring,
                                                       float middle) {
  std::array<cv::Point2f, 4> changes;
  int num_changes = 0;
  bool is_first_rising = false;
  for (int k = 0; k < kNumRing; ++k) {
    const int next = (k + 1) % kNumRing;
    const bool is_bright_next = ring[next] > middle;
    if ((ring[k] > middle) == is_bright_next) continue;
    if (num_changes == 4) return {};
    if (num_changes == 0) is_first_rising = is_bright_next;
    const float t = (middle - ring[k]) / (ring[next] - ring[k]);
    const cv::Point2f at(
        static_cast<float>(kRing[k][0]) * (1 - t) + static_cast<float>(kRing[next][0]) * t,
        static_cast<float>(kRing[k][1]) * (1 - t) + static_cast<float>(kRing[next][1]) * t);
    changes[num_changes++] = at / std::hypot(at.x, at.y);
  }
  if (num_changes != 4) return {};
  if (!is_first_rising) std::rotate(changes.begin(), changes.begin() + 1, changes.end());
  return changes;
}

// Unit direction of the line through two points of the circle that should be opposite; nothing if
// they are not: a corner half a pixel off the circle's centre turns each by up to 10 degrees, noise
// and uneven light by as much again.
std::optional<cv::Point2f> LineThrough(const cv::Point2f& a, const cv::Point2f& b) {
  constexpr float kMaxCosine = -0.76F;  // 40 degrees off
  if (a.dot(b) > kMaxCosine) return {};
  const cv::Point2f difference = a - b;
  return difference / std::hypot(difference.x, difference.y);
}

using Ring = std::array<float, kNumRing>;

Ring RingAround(const cv::Mat& smooth, int x, int y) {
  Ring ring;
  for (int k = 0; k < kNumRing; ++k) {
    ring[k] = static_cast<float>(smooth.ptr<short>(y + kRing[k][1])[x + kRing[k][0]]);
  }
  return ring;
}

// The same around any point, interpolated.
Ring RingAround(const cv::Mat& smooth, const cv::Point2f& centre) {
  const int x = cvFloor(centre.x);
  const int y = cvFloor(centre.y);
  const float right = centre.x - static_cast<float>(x);
  const float down = centre.y - static_cast<float>(y);
  Ring ring;
  for (int k = 0; k < kNumRing; ++k) {
    const short* above = smooth.ptr<short>(y + kRing[k][1]) + x + kRing[k][0];
    const short* below = smooth.ptr<short>(y + 1 + kRing[k][1]) + x + kRing[k][0];
    ring[k] = (1 - down) * ((1 - right) * above[0] + right * above[1]) +
              down * ((1 - right) * below[0] + right * below[1]);
  }
  return ring;
}

std::optional<XCorner> XCornerAt(const cv::Mat& smooth, int x, int y) {
  // Around the pixel first, as most pixels end here: an upright corner half a pixel off lends its
  // opposite pixels a difference of 0.25 by that alone.
  constexpr float kMaxAsymmetryOfPixel = 0.4F;
  const Ring around_pixel = RingAround(smooth, x, y);
  const auto [low, high] = std::minmax_element(around_pixel.begin(), around_pixel.end());
  if (*high - *low < kMinContrast * kScale) return {};
  if (Asymmetry(around_pixel) > kMaxAsymmetryOfPixel * (*high - *low)) return {};
  const auto position = SaddlePoint(smooth, x, y);
  if (!position) return {};

  const Ring ring = RingAround(smooth, *position);
  const auto [darkest, brightest] = std::minmax_element(ring.begin(), ring.end());
  if (Asymmetry(ring) > kMaxAsymmetry * (*brightest - *darkest)) return {};
  const auto changes = ShadeChanges(ring, (*brightest + *darkest) / 2);
  if (!changes) return {};
  const auto rising = LineThrough((*changes)[0], (*changes)[2]);
  const auto falling = LineThrough((*changes)[1], (*changes)[3]);
  if (!rising || !falling) return {};
  constexpr float kMinSine = 0.25F;  // 15 degrees: a board seen at 80 degrees, corner on
  if (rising->cross(*falling) < kMinSine) return {};
  return XCorner{*position, {*rising, *falling}, (*brightest - *darkest) / kScale};
}

// Whether any of the next kBlock pixels is saddle enough: most blocks have none, and asking one by
// one takes longer.
constexpr int kBlock = 32;
bool HasSaddle(const float* saddle, float min_saddle) {
  int num = 0;
  for (int i = 0; i < kBlock; ++i) num += saddle[i] >= min_saddle ? 1 : 0;
  return num > 0;
}

}  // namespace

std::vector<XCorner> FindXCorners(const cv::Mat& grey, std::size_t max_corners) {
  constexpr int kBorderPx = kRadiusPx + 2;  // a saddle may be off the pixel, and is interpolated
  if (std::min(grey.cols, grey.rows) <= 2 * kBorderPx) return {};
  const cv::Mat smooth = Smoothed(grey);
  const float min_saddle = kMinSaddle * kMinSaddle * kScale * kScale;
  std::vector<XCorner> corners;
  const int num_columns = grey.cols + kBlock;  // the last block may go beyond the image
  std::vector<float> above(num_columns), here(num_columns), below(num_columns);
  SaddleRow(smooth, kBorderPx - 1, &here);
  SaddleRow(smooth, kBorderPx, &below);
  for (int y = kBorderPx; y < grey.rows - kBorderPx; ++y) {
    std::swap(above, here);
    std::swap(here, below);
    SaddleRow(smooth, y + 1, &below);
    for (int x = kBorderPx; x < grey.cols - kBorderPx; ++x) {
      if ((x - kBorderPx) % kBlock == 0 && !HasSaddle(&here[x], min_saddle)) {
        x += kBlock - 1;
        continue;
      }
      const float s = here[x];
      if (s < min_saddle || s <= here[x - 1] || s < here[x + 1]) continue;
      if (s <= *std::max_element(&above[x - 1], &above[x + 2])) continue;
      if (s < *std::max_element(&below[x - 1], &below[x + 2])) continue;
      if (const auto corner = XCornerAt(smooth, x, y)) corners.push_back(*corner);
    }
  }
  std::stable_sort(corners.begin(), corners.end(), [](const XCorner& a, const XCorner& b) {
    return a.contrast > b.contrast;
  });
  if (corners.size() > max_corners) corners.resize(max_corners);
  return corners;
}

}  // namespace voqcal
