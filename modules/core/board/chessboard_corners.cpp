#include "core/board/chessboard_corners.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

using Corners = std::vector<cv::Point2f>;

enum class Finder { kQuads, kRadon };

// One attempt: a finder, and how many pixels of the image's longer side it sees.
struct Attempt {
  Finder finder;
  int max_side_px;
};

// Cheapest first. On the 30 images of the real session (1920 x 1208) the quads finder takes about 7
// ms at a third of the size and finds 29, 15 ms at half and finds all; findChessboardCornersSB
// takes 40 ms at a third (29 found), 80 ms at half (29) and 370 ms at full size (29). The quads
// finder's own quick check ends a search without a board early; without it one attempt takes 180 ms
// even at a third.
constexpr Attempt kAttempts[] = {
    {Finder::kQuads, 640}, {Finder::kQuads, 960}, {Finder::kRadon, 960}, {Finder::kQuads, 1 << 20}};

cv::Mat Reduced(const cv::Mat& grey, int max_side_px) {
  const int side_px = std::max(grey.cols, grey.rows);
  if (side_px <= max_side_px) return grey;
  const double scale = static_cast<double>(max_side_px) / side_px;
  cv::Mat reduced;
  cv::resize(grey, reduced, cv::Size(), scale, scale, cv::INTER_AREA);
  return reduced;
}

// A finder's corners in the pixels of `image`; empty if it finds none. It throws on images too
// small to hold a board: no board, either.
Corners CoarseCorners(const cv::Mat& image, const cv::Size& pattern, Finder finder) {
  constexpr int kQuadFlags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  Corners corners;
  try {
    const bool is_found = finder == Finder::kQuads
                              ? cv::findChessboardCorners(image, pattern, corners, kQuadFlags)
                              : cv::findChessboardCornersSB(image, pattern, corners);
    if (!is_found) return {};
  } catch (const cv::Exception&) {
    return {};
  }
  return corners.size() == static_cast<std::size_t>(pattern.area()) ? corners : Corners{};
}

// Pixels of the image that was reduced by area: pixel centres lie at whole numbers in both.
void Enlarge(const cv::Size& reduced, const cv::Size& full, Corners* corners) {
  const float scale_x = static_cast<float>(full.width) / static_cast<float>(reduced.width);
  const float scale_y = static_cast<float>(full.height) / static_cast<float>(reduced.height);
  for (cv::Point2f& p : *corners) {
    p.x = (p.x + 0.5f) * scale_x - 0.5f;
    p.y = (p.y + 0.5f) * scale_y - 0.5f;
  }
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

// cv::cornerSubPix at full size, rather than the finders' own sub-pixel corners: on the real
// session the reprojection RMS is 0.16 px against 0.18 px of findChessboardCornersSB at full size,
// and the result does not depend on which attempt came first (to 0.003 px). Half a window of 0.35
// squares gave the least RMS (0.1: 0.21 px, 0.2: 0.17, 0.5: 0.16) and even its diagonal stays off
// the next corner.
bool RefineCorners(const cv::Mat& grey, const cv::Size& pattern, Corners* corners) {
  constexpr double kHalfWindowSquares = 0.35;
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4);
  const int half_window_px =
      std::max(2, static_cast<int>(kHalfWindowSquares * ShortestSide(*corners, pattern)));
  try {
    cv::cornerSubPix(grey, *corners, {half_window_px, half_window_px}, {-1, -1}, until);
  } catch (const cv::Exception&) {
    return false;  // the window does not fit into the image
  }
  return true;
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

void Orient(Grid* grid) {
  // Seen from the front with board y up, board x points right: in pixels, y down, x cross y < 0.
  const Eigen::Vector2d x = grid->AxisX();
  const Eigen::Vector2d y = grid->AxisY();
  if (x.x() * y.y() - x.y() * y.x() > 0) grid->ReverseRows();
  // A square grid also allows quarter turns: the y axis is the one nearer to the vertical.
  if (grid->num_x == grid->num_y &&
      std::abs(Upness(grid->AxisX())) > std::abs(Upness(grid->AxisY()))) {
    grid->TurnByQuarter();
  }
  constexpr double kHorizontal = 1e-3;  // below what corners of 0.1 px say of an axis of 100 px
  const double y_up = Upness(grid->AxisY());
  const double up = std::abs(y_up) > kHorizontal ? y_up : Upness(grid->AxisX());
  if (up < 0) grid->TurnByHalf();
}

}  // namespace

std::optional<std::vector<Eigen::Vector2d>> FindChessboardCorners(const cv::Mat& grey,
                                                                  const BoardSpec& board) {
  const cv::Size pattern(board.num_corners_x, board.num_corners_y);
  for (const Attempt& attempt : kAttempts) {
    const cv::Mat reduced = Reduced(grey, attempt.max_side_px);
    Corners corners = CoarseCorners(reduced, pattern, attempt.finder);
    if (corners.empty()) continue;
    Enlarge(reduced.size(), grey.size(), &corners);
    if (!RefineCorners(grey, pattern, &corners)) continue;
    Grid grid{pattern.width, pattern.height, {}};
    for (const cv::Point2f& p : corners) grid.corners_px.emplace_back(p.x, p.y);
    Orient(&grid);
    return grid.corners_px;
  }
  return std::nullopt;
}

}  // namespace voqcal
