#include "core/assessment/lens_cause.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/assessment/rig_questions.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/format.hpp"
#include "core/lens_calibration/lens_fit.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

// Infinite where no pose explains the corners.
std::vector<double> RmsPx(const Views& views_px,
                          const BoardSpec& board,
                          const CameraModel& camera) {
  const std::vector<Eigen::Vector3d> corners_board_m = board.InnerCornersBoardM();
  std::vector<double> rms_px;
  for (const std::vector<Eigen::Vector2d>& corners_px : views_px) {
    const auto fit = FitSeenCorners(camera, corners_board_m, corners_px);
    rms_px.push_back(fit ? fit->reprojection_rms_px : std::numeric_limits<double>::infinity());
  }
  return rms_px;
}

// Views that do not fit the camera.
struct UnfittingViews {
  const Views& views_px;
  const BoardSpec& board;
  const CameraModel& camera;
  double max_rms_px;
};

// The answer by which most fit, and far better than as it is, with the smallest median.
std::optional<LensCause> BestOf(const std::vector<RigQuestion>& questions,
                                const UnfittingViews& unfitting) {
  constexpr double kLeastShare = 0.7;  // a few views may be spoilt by something else
  // Of the RMS as it is: a lens that is nearly the right one, or a bent board, is a little better
  // through many another lens.
  constexpr double kMostOfBefore = 1.0 / 3;
  double smallest_px =
      kMostOfBefore * Median(RmsPx(unfitting.views_px, unfitting.board, unfitting.camera));
  std::optional<LensCause> best;
  for (const RigQuestion& question : questions) {
    GivenSession other{unfitting.board, unfitting.camera, {}};
    question.undo(&other);
    const std::vector<double> rms_px = RmsPx(unfitting.views_px, other.board, other.camera);
    const auto num_fitting =
        static_cast<std::size_t>(std::count_if(rms_px.begin(), rms_px.end(), [&](double each_px) {
          return each_px <= unfitting.max_rms_px;
        }));
    const bool fit_most = static_cast<double>(num_fitting) >=
                          kLeastShare * static_cast<double>(unfitting.views_px.size());
    const double median_px = Median(rms_px);
    if (!fit_most || !(median_px < smallest_px)) continue;
    smallest_px = median_px;
    best = LensCause{question.cause, question.claim, question.remedy, num_fitting};
  }
  return best;
}

}  // namespace

std::optional<CameraModel> FittedCamera(const Views& views_px,
                                        const BoardSpec& board,
                                        const CameraModel& camera) {
  constexpr double kHugePx = 2.0;  // a few views may be spoilt by something else
  std::vector<LensView> views;
  for (const std::vector<Eigen::Vector2d>& corners_px : views_px) {
    views.push_back({static_cast<std::int64_t>(views.size()), corners_px, 0.0});
  }
  const std::vector<Eigen::Vector3d> corners_board_m = board.InnerCornersBoardM();
  const cv::Size image_px(camera.width_px, camera.height_px);
  const auto start = StartLens(camera.lens, image_px, corners_board_m, views);
  if (!start) return {};
  const auto fit = FitLens(WholeForm(camera.lens), corners_board_m, views, *start, kHugePx);
  return fit ? std::optional(fit->camera) : std::nullopt;
}

std::optional<LensCause> FindLensCause(const Views& views_px,
                                       const BoardSpec& board,
                                       const CameraModel& camera,
                                       double max_rms_px) {
  constexpr std::size_t kFewestViews = 5;
  if (views_px.size() < kFewestViews) return {};
  const UnfittingViews unfitting{views_px, board, camera, max_rms_px};
  if (const auto kind = BestOf(QuestionsAboutLens(camera), unfitting)) return kind;
  const auto fitted = FittedCamera(views_px, board, camera);
  return fitted ? BestOf(QuestionsAboutNumbers(camera, *fitted), unfitting) : std::nullopt;
}

}  // namespace voqcal
