#include "core/assessment/lens_cause.hpp"

#include <algorithm>
#include <utility>

#include "core/assessment/given_session.hpp"
#include "core/assessment/rig_questions.hpp"

namespace voqcal {
namespace {

std::size_t NumFitting(const GivenSession& session, double max_rms_px) {
  return static_cast<std::size_t>(
      std::count_if(session.samples.begin(), session.samples.end(), [&](const BoardSample& sample) {
        return sample.camera.reprojection_rms_px <= max_rms_px;
      }));
}

}  // namespace

std::optional<LensCause> FindLensCause(const std::vector<std::vector<Eigen::Vector2d>>& views_px,
                                       const BoardSpec& board,
                                       const CameraModel& camera,
                                       double max_rms_px) {
  constexpr std::size_t kFewestViews = 5;
  constexpr double kLeastShare = 0.7;  // a few views may be spoilt by something else
  if (views_px.size() < kFewestViews) return {};
  GivenSession given{board, camera, {}};
  for (const std::vector<Eigen::Vector2d>& corners_px : views_px) {
    given.samples.emplace_back().camera.corners_px = corners_px;
  }
  std::optional<LensCause> best;
  for (const RigQuestion& question : QuestionsAbout(board, camera)) {
    GivenSession session = given;
    question.undo(&session);
    const std::size_t num = NumFitting(session, max_rms_px);
    if (static_cast<double>(num) < kLeastShare * static_cast<double>(views_px.size())) continue;
    if (best && num <= best->num_fitting) continue;
    best = LensCause{question.cause, question.claim, question.remedy, num};
  }
  return best;
}

}  // namespace voqcal
