#include "core/camera_detection/x_corner_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <ceres/tiny_solver.h>

namespace voqcal {
namespace {

// A pixel, from the guessed corner, and its grey level.
struct Pixel {
  Eigen::Vector2d at_px;
  double level;
};

// The pixels of the parallelogram that the guess spans; none if it leaves the image.
std::vector<Pixel> PixelsAround(const cv::Mat& grey, const XCornerGuess& guess) {
  Eigen::Matrix2d reach_px;
  reach_px << guess.reach_x_px, guess.reach_y_px;
  const Eigen::Matrix2d to_reaches = reach_px.inverse();
  const Eigen::Array2d half_px = reach_px.cwiseAbs().rowwise().sum();
  const Eigen::Array2d from_px = (guess.position_px.array() - half_px).ceil();
  const Eigen::Array2d to_px = (guess.position_px.array() + half_px).floor();
  const bool is_inside = to_reaches.allFinite() && (from_px >= 0).all() && to_px.x() < grey.cols &&
                         to_px.y() < grey.rows;
  if (!is_inside) return {};
  std::vector<Pixel> pixels;
  for (int y = static_cast<int>(from_px.y()); y <= to_px.y(); ++y) {
    for (int x = static_cast<int>(from_px.x()); x <= to_px.x(); ++x) {
      const Eigen::Vector2d at_px = Eigen::Vector2d(x, y) - guess.position_px;
      if ((to_reaches * at_px).cwiseAbs().maxCoeff() > 1) continue;
      pixels.push_back({at_px, static_cast<double>(grey.at<unsigned char>(y, x))});
    }
  }
  return pixels;
}

// A step from -1 to 1 under a Gaussian blur of sigma 1, and its slope.
double Step(double t) { return std::erf(t * M_SQRT1_2); }
double Slope(double t) { return M_SQRT1_2 * M_2_SQRTPI * std::exp(-t * t / 2); }

// What the pixels' levels differ by from two blurred edges that cross at c:
//     level(p) = mean + contrast * Step(n_x . (p - c) / w) * Step(n_y . (p - c) / w)
// n: unit normals of the edges; w^2 = blur^2 + that of a square pixel, 1/12 px^2.
class CrossingEdges {
 public:
  enum Parameter { kX, kY, kAngleX, kAngleY, kMean, kContrast, kBlur, kNumParameters };

  // What ceres::TinySolver asks for.
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kNumParameters };
  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;

  explicit CrossingEdges(const std::vector<Pixel>& pixels) : pixels_(pixels) {}

  int NumResiduals() const { return static_cast<int>(pixels_.size()); }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const double* q = parameters;
    const Eigen::Vector2d n_x(std::cos(q[kAngleX]), std::sin(q[kAngleX]));
    const Eigen::Vector2d n_y(std::cos(q[kAngleY]), std::sin(q[kAngleY]));
    const double w = std::sqrt(q[kBlur] * q[kBlur] + 1.0 / 12);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kNumParameters>> J(
        jacobian, jacobian == nullptr ? 0 : NumResiduals(), kNumParameters);
    for (int k = 0; k < NumResiduals(); ++k) {
      const Eigen::Vector2d from_c = pixels_[k].at_px - Eigen::Vector2d(q[kX], q[kY]);
      const double t_x = n_x.dot(from_c) / w;
      const double t_y = n_y.dot(from_c) / w;
      const double steps = Step(t_x) * Step(t_y);
      residuals[k] = q[kMean] + q[kContrast] * steps - pixels_[k].level;
      if (jacobian == nullptr) continue;
      const double by_t_x = q[kContrast] * Slope(t_x) * Step(t_y);
      const double by_t_y = q[kContrast] * Step(t_x) * Slope(t_y);
      J(k, kX) = -(by_t_x * n_x.x() + by_t_y * n_y.x()) / w;
      J(k, kY) = -(by_t_x * n_x.y() + by_t_y * n_y.y()) / w;
      J(k, kAngleX) = by_t_x * (n_x.x() * from_c.y() - n_x.y() * from_c.x()) / w;
      J(k, kAngleY) = by_t_y * (n_y.x() * from_c.y() - n_y.y() * from_c.x()) / w;
      J(k, kMean) = 1;
      J(k, kContrast) = steps;
      J(k, kBlur) = -(by_t_x * t_x + by_t_y * t_y) * q[kBlur] / (w * w);
    }
    return true;
  }

 private:
  const std::vector<Pixel>& pixels_;
};

double AngleOfNormal(const Eigen::Vector2d& edge) { return std::atan2(edge.x(), -edge.y()); }

CrossingEdges::Parameters StartOf(const XCornerGuess& guess, const std::vector<Pixel>& pixels) {
  constexpr double kBlurPx = 0.6;  // a sharp lens
  CrossingEdges::Parameters start;
  start << 0, 0, AngleOfNormal(guess.reach_x_px), AngleOfNormal(guess.reach_y_px), 0, 0, kBlurPx;
  // By the means of opposite quarters.
  Eigen::Array2d sums(0, 0);
  Eigen::Array2d nums(0, 0);
  const auto side = [&](int angle, const Pixel& pixel) {
    return std::cos(start[angle]) * pixel.at_px.x() + std::sin(start[angle]) * pixel.at_px.y() > 0;
  };
  for (const Pixel& pixel : pixels) {
    const int quarter =
        side(CrossingEdges::kAngleX, pixel) == side(CrossingEdges::kAngleY, pixel) ? 1 : 0;
    sums[quarter] += pixel.level;
    nums[quarter] += 1;
  }
  const Eigen::Array2d means = sums / nums.max(1);
  start[CrossingEdges::kMean] = means.mean();
  start[CrossingEdges::kContrast] = (means[1] - means[0]) / 2;
  return start;
}

}  // namespace

std::optional<Eigen::Vector2d> FitXCorner(const cv::Mat& grey, const XCornerGuess& guess) {
  constexpr std::size_t kMinPixels = 16;  // 7 unknowns
  constexpr double kMinContrast = 4;      // grey levels to either side
  constexpr double kMaxMisfit = 0.3;      // RMS, of the contrast; a single edge has 0.5 and more
  const std::vector<Pixel> pixels = PixelsAround(grey, guess);
  if (pixels.size() < kMinPixels) return {};

  const CrossingEdges edges(pixels);
  CrossingEdges::Parameters fit = StartOf(guess, pixels);
  ceres::TinySolver<CrossingEdges> solver;
  solver.options.max_num_iterations = 30;
  solver.Solve(edges, &fit);

  const double misfit =
      std::sqrt(2 * solver.summary.final_cost / static_cast<double>(pixels.size()));
  const double contrast = std::abs(fit[CrossingEdges::kContrast]);
  const Eigen::Vector2d shift_px = fit.head<2>();
  const double max_shift_px =
      std::max(1.0, std::min(guess.reach_x_px.norm(), guess.reach_y_px.norm()) / 3);
  const bool is_good = contrast >= kMinContrast && misfit <= kMaxMisfit * contrast &&
                       shift_px.norm() <= max_shift_px;
  if (!is_good) return {};
  return guess.position_px + shift_px;
}

}  // namespace voqcal
