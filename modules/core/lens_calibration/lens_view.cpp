#include "core/lens_calibration/lens_view.hpp"

#include <algorithm>
#include <cmath>

#include "core/camera_detection/calibration_target.hpp"
#include "core/camera_detection/camera_board_view.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/format.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinCorners = 8;
constexpr std::size_t kMinShare = 3;  // one of so many
constexpr double kSharpPx = 3.0;      // as the board detector has it

// Wide enough that a board in it looks as one does, to find the edges between corners by.
CameraModel AnyCamera(const cv::Size& image_px) {
  CameraModel camera;
  camera.lens = LensModel::kEquidistant;
  camera.width_px = image_px.width;
  camera.height_px = image_px.height;
  camera.fx_px = camera.fy_px = 0.7 * std::max(image_px.width, image_px.height);
  camera.cx_px = (image_px.width - 1) / 2.0;
  camera.cy_px = (image_px.height - 1) / 2.0;
  return camera;
}

// How far the corners that both show lie apart, corner by corner.
std::vector<double> MotionsPx(const LensView& a, const LensView& b, bool is_half_turned) {
  std::vector<double> motions_px;
  const std::size_t num = a.corners_px.size();
  for (std::size_t i = 0; i < num; ++i) {
    const Eigen::Vector2d motion = a.corners_px[i] - b.corners_px[is_half_turned ? num - 1 - i : i];
    if (motion.allFinite()) motions_px.push_back(motion.norm());
  }
  return motions_px;
}

// Of a pattern that looks the same after half a turn, the smaller of both.
template <typename Measure>
double SmallerMotionPx(const LensView& a,
                       const LensView& b,
                       bool has_half_turn,
                       const Measure& measure) {
  const double motion_px = measure(MotionsPx(a, b, false));
  return has_half_turn ? std::min(motion_px, measure(MotionsPx(a, b, true))) : motion_px;
}

// Without common corners: other parts of the image, or of the board.
double RmsOrFar(const std::vector<double>& motions_px) {
  double sum_px2 = 0;
  for (const double motion : motions_px) sum_px2 += motion * motion;
  return motions_px.empty() ? HUGE_VAL
                            : std::sqrt(sum_px2 / static_cast<double>(motions_px.size()));
}

// How far the board moved from each view to the next, if that is near enough in time to tell; else
// NaN. All NaN where most are new poses: stills, however their times were made.
std::vector<double> MotionsToNextPx(const std::vector<LensView>& views,
                                    bool has_half_turn,
                                    double max_neighbour_s,
                                    double min_new_px) {
  std::vector<double> motions_px(views.size(), std::nan(""));
  std::vector<double> known_px;
  for (std::size_t i = 0; i + 1 < views.size(); ++i) {
    const double apart_s = 1e-6 * static_cast<double>(views[i + 1].utime - views[i].utime);
    if (!(apart_s > 0 && apart_s <= max_neighbour_s)) continue;
    motions_px[i] = SmallerMotionPx(views[i], views[i + 1], has_half_turn, Median);
    if (!std::isnan(motions_px[i])) known_px.push_back(motions_px[i]);
  }
  if (known_px.empty() || Median(known_px) > min_new_px)
    motions_px.assign(views.size(), std::nan(""));
  return motions_px;
}

bool IsMoving(const std::vector<double>& motions_to_next_px, std::size_t i, double max_px) {
  const double before_px = i > 0 ? motions_to_next_px[i - 1] : std::nan("");
  const double least_px = std::fmin(before_px, motions_to_next_px[i]);  // of those known
  return least_px > max_px;
}

double MaxEdgeWidthPx(const std::vector<LensView>& views, double ratio) {
  std::vector<double> widths_px;
  for (const LensView& view : views) {
    if (std::isfinite(view.edge_width_px)) widths_px.push_back(view.edge_width_px);
  }
  return widths_px.empty() ? HUGE_VAL : std::max(kSharpPx, ratio * Median(widths_px));
}

}  // namespace

std::size_t NumCorners(const LensView& view) {
  return static_cast<std::size_t>(std::count_if(
      view.corners_px.begin(), view.corners_px.end(), [](const Eigen::Vector2d& corner) {
        return corner.allFinite();
      }));
}

Expected<LensView, CameraBoardMiss> SeeLensView(const cv::Mat& grey,
                                                const BoardSpec& board,
                                                std::int64_t utime) {
  const auto corners_px = TargetOf(board).find_corners(grey, board);
  if (!corners_px) return corners_px.error();
  LensView view;
  view.utime = utime;
  view.corners_px = *corners_px;
  const std::size_t num = NumCorners(view);
  if (num < std::max(kMinCorners, view.corners_px.size() / kMinShare)) {
    return CameraBoardMiss{CameraBoardFault::kPartlyHidden, Format("%zu corners", num)};
  }
  const CameraModel camera = AnyCamera(grey.size());
  view.edge_width_px = std::nan("");
  const auto pose = FitSeenCorners(camera, board.InnerCornersBoardM(), view.corners_px);
  if (pose) {
    view.edge_width_px =
        MeasureView(grey, camera, board, pose->T_camera_board, view.corners_px).edge_width_px;
  }
  return view;
}

ViewChoice ChooseViews(const std::vector<LensView>& views,
                       const BoardSpec& board,
                       const cv::Size& image_px,
                       const ViewChoiceOptions& options) {
  const bool has_half_turn = TargetOf(board).has_half_turn(board);
  const double min_new_px = options.min_new_motion * std::hypot(image_px.width, image_px.height);
  const std::vector<double> motions_px =
      MotionsToNextPx(views, has_half_turn, options.max_neighbour_s, min_new_px);
  const double max_width_px = MaxEdgeWidthPx(views, options.max_edge_width_ratio);
  ViewChoice choice;
  std::vector<const LensView*> left;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (IsMoving(motions_px, i, options.max_still_motion_px)) {
      ++choice.num_moving;
    } else if (views[i].edge_width_px > max_width_px) {
      ++choice.num_blurred;
    } else {
      left.push_back(&views[i]);
    }
  }
  std::vector<double> differences_px(left.size(), HUGE_VAL);  // from the nearest that was taken
  std::vector<const LensView*> taken;
  while (taken.size() < options.max_views && !left.empty()) {
    const auto most = std::max_element(differences_px.begin(), differences_px.end());
    if (*most < min_new_px) break;
    taken.push_back(left[static_cast<std::size_t>(most - differences_px.begin())]);
    for (std::size_t i = 0; i < left.size(); ++i) {
      differences_px[i] =
          std::min(differences_px[i],
                   left[i] == taken.back()
                       ? 0.0
                       : SmallerMotionPx(*left[i], *taken.back(), has_half_turn, RmsOrFar));
    }
  }
  choice.num_beyond = static_cast<std::size_t>(
      std::count_if(differences_px.begin(), differences_px.end(), [&](double difference_px) {
        return difference_px >= min_new_px;
      }));
  choice.num_repeated = left.size() - taken.size() - choice.num_beyond;
  std::sort(taken.begin(), taken.end());  // by their places in `views`
  for (const LensView* view : taken) choice.views.push_back(*view);
  return choice;
}

}  // namespace voqcal
