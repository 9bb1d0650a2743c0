#include "core/camera_detection/chessboard_corners.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/corner_grid.hpp"
#include "core/camera_detection/missing_corners.hpp"
#include "core/camera_detection/x_corners.hpp"

namespace voqcal {
namespace {

using Corners = std::vector<cv::Point2f>;

// Why a search of our own: on the real session's images (1920 x 1208), and on those images blurred,
// darkened, shrunk and with noise added, it misses none that cv::findChessboardCorners or
// cv::findChessboardCornersSB find but for noise that hides squares of 6 px, takes a hundredth of
// the time of the latter, and where there is no board it ends as soon, while they try hardest.

// The image and its halvings down to a longer side of about 200 px, the smallest last. Small images
// are cheap, and blur and noise are small in them; large ones show small boards.
std::vector<cv::Mat> Pyramid(const cv::Mat& grey) {
  constexpr int kMinSidePx = 200;
  std::vector<cv::Mat> levels{grey};
  while (std::max(levels.back().cols, levels.back().rows) / 2 >= kMinSidePx) {
    cv::Mat half;
    cv::resize(levels.back(), half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    levels.push_back(half);
  }
  return levels;
}

// From the pixels of one level to those of another: pixel centres lie at whole numbers in both.
Corners Rescaled(Corners corners, const cv::Size& from, const cv::Size& to) {
  const float scale_x = static_cast<float>(to.width) / static_cast<float>(from.width);
  const float scale_y = static_cast<float>(to.height) / static_cast<float>(from.height);
  for (cv::Point2f& p : corners) {
    p.x = (p.x + 0.5f) * scale_x - 0.5f;
    p.y = (p.y + 0.5f) * scale_y - 0.5f;
  }
  return corners;
}

// Distance between the two nearest neighbours of the grid.
double ShortestSide(const Corners& corners, const cv::Size& pattern) {
  double shortest_px = HUGE_VAL;
  for (int j = 0; j < pattern.height; ++j) {
    for (int i = 0; i < pattern.width; ++i) {
      const int k = j * pattern.width + i;
      if (i > 0) shortest_px = std::min(shortest_px, cv::norm(corners[k] - corners[k - 1]));
      if (j > 0) {
        shortest_px = std::min(shortest_px, cv::norm(corners[k] - corners[k - pattern.width]));
      }
    }
  }
  return shortest_px;
}

// cv::cornerSubPix on one level. False if a corner went astray: in an image so blurred that the
// window holds no edge of its own, corners drift towards the next one, or come back from there
// exactly to where they started.
bool RefineOn(const cv::Mat& level, const cv::Size& pattern, Corners* corners) {
  // Of the real session's images, 0.35 gave the least reprojection RMS (0.1: 0.21 px, 0.2: 0.17,
  // 0.35 and 0.5: 0.16), and even its diagonal stays off the next corner.
  constexpr double kHalfWindowSquares = 0.35;
  constexpr int kMaxHalfWindowPx = 30;      // more adds time and no accuracy
  constexpr double kMaxShiftSquares = 0.1;  // a square of 5 px, a coarse corner off by half a pixel
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-4);
  const double side_px = ShortestSide(*corners, pattern);
  const int half_window_px =
      std::clamp(static_cast<int>(kHalfWindowSquares * side_px), 2, kMaxHalfWindowPx);
  const Corners start = *corners;
  try {
    cv::cornerSubPix(level, *corners, {half_window_px, half_window_px}, {-1, -1}, until);
  } catch (const cv::Exception&) {
    return false;  // the window does not fit into the image
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double shift_px = cv::norm((*corners)[i] - start[i]);
    if (shift_px == 0 || shift_px > kMaxShiftSquares * side_px) return false;
  }
  return true;
}

// The coarse corners of level `found`, refined on the largest level that is sharp enough, in the
// pixels of level 0. The result does not depend on `found`, to 0.003 px.
Corners Refined(const std::vector<cv::Mat>& levels,
                std::size_t found,
                const Corners& coarse,
                const cv::Size& pattern) {
  for (std::size_t i = 0; i <= found; ++i) {
    Corners corners = Rescaled(coarse, levels[found].size(), levels[i].size());
    if (RefineOn(levels[i], pattern, &corners)) {
      return Rescaled(std::move(corners), levels[i].size(), levels[0].size());
    }
  }
  return Rescaled(coarse, levels[found].size(), levels[0].size());
}

// Few enough corners are missing that the others say where they must be.
bool IsNearlyWhole(const CornerGrid& grid, const cv::Size& pattern) {
  constexpr double kMinShare = 0.7;
  return grid.size == pattern && grid.num_found < pattern.area() &&
         grid.num_found >= kMinShare * pattern.area();
}

// A grid of corners in the image, x fastest, and the turns that it allows.
struct Grid {
  int num_x;
  int num_y;
  std::vector<Eigen::Vector2d> corners_px;

  const Eigen::Vector2d& At(int i, int j) const { return corners_px[j * num_x + i]; }

  // From the first to the last column, and from the first to the last row, summed over the other
  // axis.
  Eigen::Vector2d AxisX() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int j = 0; j < num_y; ++j) sum += At(num_x - 1, j) - At(0, j);
    return sum / num_y;
  }
  Eigen::Vector2d AxisY() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = 0; i < num_x; ++i) sum += At(i, num_y - 1) - At(i, 0);
    return sum / num_x;
  }

  void ReverseRows() {
    for (int j = 0; j < num_y; ++j) {
      std::reverse(corners_px.begin() + j * num_x, corners_px.begin() + (j + 1) * num_x);
    }
  }
  void TurnByHalf() { std::reverse(corners_px.begin(), corners_px.end()); }
  void TurnByQuarter() {  // of a square grid: new x is old y, new y is old -x
    const Grid old = *this;
    for (int j = 0; j < num_y; ++j) {
      for (int i = 0; i < num_x; ++i) corners_px[j * num_x + i] = old.At(num_x - 1 - j, i);
    }
  }
};

// How far an axis points up in the image, -1 to 1: pixel y points down.
double Upness(const Eigen::Vector2d& axis_px) { return -axis_px.y() / axis_px.norm(); }

// Where num_x + num_y is odd the pattern tells its two half-turns apart: whether this is the one
// with a bright square at its corner (0, 0), and so with bright squares wherever i + j is even.
bool IsBrightFirst(const cv::Mat& grey, const Grid& grid) {
  double even_minus_odd = 0;
  for (int j = 0; j + 1 < grid.num_y; ++j) {
    for (int i = 0; i + 1 < grid.num_x; ++i) {
      const Eigen::Vector2d centre_px =
          (grid.At(i, j) + grid.At(i + 1, j) + grid.At(i, j + 1) + grid.At(i + 1, j + 1)) / 4;
      const double level = grey.at<std::uint8_t>(cvRound(centre_px.y()), cvRound(centre_px.x()));
      even_minus_odd += (i + j) % 2 == 0 ? level : -level;
    }
  }
  return even_minus_odd > 0;
}

void Orient(const cv::Mat& grey, Grid* grid) {
  // Seen from the front with board y up, board x points right: in pixels, y down, x cross y < 0.
  const Eigen::Vector2d x = grid->AxisX();
  const Eigen::Vector2d y = grid->AxisY();
  if (x.x() * y.y() - x.y() * y.x() > 0) grid->ReverseRows();
  // A square grid also allows quarter turns: the y axis is the one nearer to the vertical.
  if (grid->num_x == grid->num_y &&
      std::abs(Upness(grid->AxisX())) > std::abs(Upness(grid->AxisY()))) {
    grid->TurnByQuarter();
  }
  if ((grid->num_x + grid->num_y) % 2 == 1) {
    if (IsBrightFirst(grey, *grid)) grid->TurnByHalf();
    return;
  }
  constexpr double kHorizontal = 1e-3;  // below what corners of 0.1 px say of an axis of 100 px
  const double y_up = Upness(grid->AxisY());
  const double up = std::abs(y_up) > kHorizontal ? y_up : Upness(grid->AxisX());
  if (up < 0) grid->TurnByHalf();
}

}  // namespace

Expected<std::vector<Eigen::Vector2d>, CornerGrid> FindChessboardCorners(const cv::Mat& grey,
                                                                         const BoardSpec& board) {
  const cv::Size pattern(board.num_corners_x, board.num_corners_y);
  const std::vector<cv::Mat> levels = Pyramid(grey);
  // A board's corners are among those of most contrast; what is beyond is texture and noise.
  const auto max_corners = static_cast<std::size_t>(std::max(600, 3 * pattern.area()));
  CornerGrid largest_part;
  for (std::size_t level = levels.size(); level-- > 0;) {
    CornerGrid coarse = FindCornerGrid(FindXCorners(levels[level], max_corners), pattern);
    if (IsNearlyWhole(coarse, pattern)) coarse = WithMissingCorners(levels[level], coarse);
    if (coarse.num_found < pattern.area()) {
      if (coarse.num_found <= largest_part.num_found) continue;
      coarse.corners = Rescaled(coarse.corners, levels[level].size(), grey.size());
      largest_part = std::move(coarse);
      continue;
    }
    Grid grid{pattern.width, pattern.height, {}};
    for (const cv::Point2f& p : Refined(levels, level, coarse.corners, pattern)) {
      grid.corners_px.emplace_back(p.x, p.y);
    }
    Orient(grey, &grid);
    return grid.corners_px;
  }
  return largest_part;
}

}  // namespace voqcal
