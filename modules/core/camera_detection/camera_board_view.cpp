#include "core/camera_detection/camera_board_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/camera_detection/calibration_target.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

// The image at any point, interpolated; nothing outside of it.
std::optional<double> GreyAt(const cv::Mat& grey, const Eigen::Vector2d& at_px) {
  const double x = std::floor(at_px.x());
  const double y = std::floor(at_px.y());
  if (!(x >= 0 && y >= 0 && x + 1 < grey.cols && y + 1 < grey.rows)) return {};
  const double right = at_px.x() - x;
  const double down = at_px.y() - y;
  const std::uint8_t* above = grey.ptr(static_cast<int>(y)) + static_cast<int>(x);
  const std::uint8_t* below = above + grey.step;
  return (1 - down) * ((1 - right) * above[0] + right * above[1]) +
         down * ((1 - right) * below[0] + right * below[1]);
}

// One image of the board, and where its parts are in it.
class Viewer {
 public:
  Viewer(const cv::Mat& grey,
         const CameraModel& camera,
         const BoardSpec& board,
         const Eigen::Isometry3d& T_camera_board,
         const std::vector<Eigen::Vector2d>& corners_px)
      : grey_(grey),
        camera_(camera),
        board_(board),
        T_camera_board_(T_camera_board),
        corners_px_(corners_px),
        corners_board_m_(board.InnerCornersBoardM()),
        reach_squares_(TargetOf(board).reach(board)) {}

  CameraBoardView Measure() const {
    CameraBoardView view;
    view.edge_width_px = std::max(EdgeWidthPx(1, 0), EdgeWidthPx(0, 1));
    view.square_px = std::min(ShortestSidePx(1, 0), ShortestSidePx(0, 1));
    view.least_contrast = LeastContrast();
    view.outside_share = OutsideShare();
    return view;
  }

 private:
  bool IsSeen(std::size_t k) const { return corners_px_[k].allFinite(); }

  // Calls `use(k, l)` for each corner k and its neighbour l towards (di, dj), both seen.
  template <typename Use>
  void ForEachSide(int di, int dj, Use use) const {
    for (int j = 0; j + dj < board_.num_corners_y; ++j) {
      for (int i = 0; i + di < board_.num_corners_x; ++i) {
        const std::size_t k = j * board_.num_corners_x + i;
        const std::size_t l = k + dj * board_.num_corners_x + di;
        if (IsSeen(k) && IsSeen(l)) use(k, l);
      }
    }
  }

  double ShortestSidePx(int di, int dj) const {
    double shortest_px = HUGE_VAL;
    ForEachSide(di, dj, [&](std::size_t k, std::size_t l) {
      shortest_px = std::min(shortest_px, (corners_px_[l] - corners_px_[k]).norm());
    });
    return shortest_px;
  }

  std::optional<Eigen::Vector2d> PixelOf(const Eigen::Vector3d& point_board_m) const {
    const Eigen::Vector3d point_camera_m = T_camera_board_ * point_board_m;
    if (!camera_.IsInFront(point_camera_m)) return {};
    return camera_.Project(point_camera_m);
  }

  // Median width of the edges between corners k and their neighbours towards (di, dj).
  double EdgeWidthPx(int di, int dj) const {
    std::vector<double> widths_px;
    ForEachSide(di, dj, [&](std::size_t k, std::size_t l) {
      const double width_px = EdgeWidthPx(corners_board_m_[k], corners_board_m_[l]);
      if (std::isfinite(width_px)) widths_px.push_back(width_px);
    });
    return Median(widths_px);
  }

  // Of one edge: its step divided by its steepest slope, both of the mean of three lines across. A
  // step blurred by a Gaussian of sigma s has the slope 1 / (s sqrt(2 pi)) and goes from 10 % to
  // 90 % within 2.563 s.
  double EdgeWidthPx(const Eigen::Vector3d& a_board_m, const Eigen::Vector3d& b_board_m) const {
    constexpr double kWidthOfSlope = 2.563 / 2.5066;
    const Eigen::Vector3d along_m = b_board_m - a_board_m;
    const Eigen::Vector3d across_m = reach_squares_ * Eigen::Vector3d(-along_m.y(), along_m.x(), 0);
    std::vector<double> levels;
    double step_px = 0;
    for (const double t : {0.35, 0.5, 0.65}) {
      const Eigen::Vector3d middle_m = a_board_m + t * along_m;
      const auto from = PixelOf(middle_m - across_m);
      const auto to = PixelOf(middle_m + across_m);
      if (!from || !to) return std::nan("");
      if (levels.empty()) {
        const auto num = static_cast<std::size_t>(2 * (*to - *from).norm());
        levels.assign(std::clamp<std::size_t>(num, 6, 120) + 1, 0.0);
      }
      const auto num_steps = static_cast<double>(levels.size() - 1);
      step_px = (*to - *from).norm() / num_steps;
      for (std::size_t n = 0; n < levels.size(); ++n) {
        const double share = static_cast<double>(n) / num_steps;
        const auto level = GreyAt(grey_, *from + share * (*to - *from));
        if (!level) return std::nan("");
        levels[n] += *level / 3;
      }
    }
    double steepest = 0;
    for (std::size_t n = 2; n < levels.size(); ++n) {
      steepest = std::max(steepest, std::abs(levels[n] - levels[n - 2]) / (2 * step_px));
    }
    return kWidthOfSlope * std::abs(levels.back() - levels.front()) / steepest;
  }

  // (bright - dark) / (bright + dark) of the four squares around a corner.
  double ContrastAround(std::size_t k) const {
    std::array<double, 2> sums{};
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double x = (quarter % 2 == 0 ? -1 : 1) * reach_squares_ * board_.square_m;
      const double y = (quarter / 2 == 0 ? -1 : 1) * reach_squares_ * board_.square_m;
      const auto pixel = PixelOf(corners_board_m_[k] + Eigen::Vector3d(x, y, 0));
      const auto level = pixel ? GreyAt(grey_, *pixel) : std::nullopt;
      if (!level) return std::nan("");
      sums[x * y > 0 ? 0 : 1] += *level;
    }
    return std::abs(sums[0] - sums[1]) / std::max(1.0, sums[0] + sums[1]);
  }

  double LeastContrast() const {
    std::vector<double> contrasts;
    for (std::size_t k = 0; k < corners_px_.size(); ++k) {
      const double contrast = IsSeen(k) ? ContrastAround(k) : std::nan("");
      if (std::isfinite(contrast)) contrasts.push_back(contrast);
    }
    if (contrasts.empty()) return std::nan("");
    return *std::min_element(contrasts.begin(), contrasts.end()) / Median(contrasts);
  }

  double OutsideShare() const {
    constexpr int kPointsPerEdge = 25;
    const auto outline_m = board_.OutlineBoardM();
    int num_outside = 0;
    for (int n = 0; n < 4 * kPointsPerEdge; ++n) {
      const int edge = n / kPointsPerEdge;
      const double t = static_cast<double>(n % kPointsPerEdge) / kPointsPerEdge;
      const auto pixel = PixelOf((1 - t) * outline_m[edge] + t * outline_m[(edge + 1) % 4]);
      if (!pixel || !camera_.Contains(*pixel)) ++num_outside;
    }
    return num_outside / (4.0 * kPointsPerEdge);
  }

  const cv::Mat& grey_;
  const CameraModel& camera_;
  const BoardSpec& board_;
  const Eigen::Isometry3d& T_camera_board_;
  const std::vector<Eigen::Vector2d>& corners_px_;
  std::vector<Eigen::Vector3d> corners_board_m_;
  double reach_squares_;
};

}  // namespace

CameraBoardView MeasureView(const cv::Mat& grey,
                            const CameraModel& camera,
                            const BoardSpec& board,
                            const Eigen::Isometry3d& T_camera_board,
                            const std::vector<Eigen::Vector2d>& corners_px) {
  return Viewer(grey, camera, board, T_camera_board, corners_px).Measure();
}

}  // namespace voqcal
