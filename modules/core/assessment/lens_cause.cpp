#include "core/assessment/lens_cause.hpp"

#include <algorithm>
#include <limits>

#include "core/assessment/rig_questions.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

using Views = std::vector<std::vector<Eigen::Vector2d>>;

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

}  // namespace

std::optional<LensCause> FindLensCause(const Views& views_px,
                                       const BoardSpec& board,
                                       const CameraModel& camera,
                                       double max_rms_px) {
  constexpr std::size_t kFewestViews = 5;
  constexpr double kLeastShare = 0.7;  // a few views may be spoilt by something else
  // Of the RMS as it is: a lens that is nearly the right one, or a bent board, is a little better
  // through many another lens.
  constexpr double kMostOfBefore = 1.0 / 3;
  if (views_px.size() < kFewestViews) return {};
  double smallest_px = kMostOfBefore * Median(RmsPx(views_px, board, camera));
  std::optional<LensCause> best;
  for (const RigQuestion& question : QuestionsAboutLens(camera)) {
    GivenSession other{board, camera, {}};
    question.undo(&other);
    const std::vector<double> rms_px = RmsPx(views_px, other.board, other.camera);
    const auto num_fitting = static_cast<std::size_t>(std::count_if(
        rms_px.begin(), rms_px.end(), [&](double each_px) { return each_px <= max_rms_px; }));
    const bool fit_most =
        static_cast<double>(num_fitting) >= kLeastShare * static_cast<double>(views_px.size());
    const double median_px = Median(rms_px);
    if (!fit_most || !(median_px < smallest_px)) continue;
    smallest_px = median_px;
    best = LensCause{question.cause, question.claim, question.remedy, num_fitting};
  }
  return best;
}

}  // namespace voqcal
