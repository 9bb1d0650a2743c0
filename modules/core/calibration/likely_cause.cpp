#include "core/calibration/likely_cause.hpp"

#include <cstddef>
#include <utility>

#include "core/assessment/lens_cause.hpp"
#include "core/assessment/rig_questions.hpp"
#include "core/board/half_turn.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/least_samples.hpp"
#include "core/median.hpp"
#include "core/selection/consistency.hpp"

namespace voqcal {
namespace {

// Of samples whose distances agree, those that one extrinsic takes onto each other, the pattern's
// turn in the plate too: it does not if one sensor is mirrored or the pattern lies across, which
// distances do not show.
std::size_t NumAgreeing(const std::vector<BoardSample>& samples,
                        const ConsistencyOptions& options) {
  const std::vector<BoardSample> consistent =
      ConsistentSamples(samples, FindConsistent(samples, options));
  if (consistent.size() < kLeastSamples) return 0;
  std::vector<const BoardSample*> all;
  for (const BoardSample& sample : consistent) all.push_back(&sample);
  const Eigen::Isometry3d T_camera_lidar = AnalyticExtrinsic(all);
  std::size_t num = 0;
  for (const BoardSample& sample : consistent) {
    const Eigen::Isometry3d T_camera_board_by_lidar =
        T_camera_lidar * TransformFromPose(LidarPoseInCameraOrder(sample, T_camera_lidar));
    const Eigen::Isometry3d off =
        TransformFromPose(sample.camera.pose).inverse() * T_camera_board_by_lidar;
    const double angle_rad = LogSO3(off.linear()).norm();
    num += off.translation().norm() < options.max_distance_m && angle_rad < options.max_angle_rad
               ? 1
               : 0;
  }
  return num;
}

/// How many times farther apart the boards' centres are by the lidar than by the camera: the median
/// over all pairs that are far apart. Squares of another size scale all distances alike; what one
/// sensor has wrong at some places leaves the median as it is.
double CentresScale(const std::vector<BoardSample>& samples) {
  constexpr double kFarM = 0.5;  // nearer ones' ratio is that of errors
  std::vector<double> ratios;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double lidar_m =
          (samples[i].lidar.pose.centre_m - samples[j].lidar.pose.centre_m).norm();
      const double camera_m =
          (samples[i].camera.pose.centre_m - samples[j].camera.pose.centre_m).norm();
      if (lidar_m > kFarM && camera_m > 0) ratios.push_back(lidar_m / camera_m);
    }
  }
  return ratios.empty() ? 1.0 : Median(ratios);
}

/// Those that make sense of any session, and those that the samples themselves raise.
std::vector<RigQuestion> QuestionsOf(const GivenSession& given) {
  std::vector<RigQuestion> questions = QuestionsAbout(given.board, given.camera);
  questions.push_back(QuestionAboutSquares(given.board, CentresScale(given.samples)));
  Views views_px;
  for (const BoardSample& sample : given.samples) {
    if (!sample.camera.corners_px.empty()) views_px.push_back(sample.camera.corners_px);
  }
  const auto fitted = FittedCamera(views_px, given.board, given.camera);
  if (!fitted) return questions;
  for (RigQuestion& each : QuestionsAboutNumbers(given.camera, *fitted)) {
    questions.push_back(std::move(each));
  }
  return questions;
}

std::vector<BoardSample> WithoutPoints(std::vector<BoardSample> samples) {
  for (BoardSample& sample : samples) {
    sample.lidar.points_lidar_m = {};
    for (LidarBoard& board : sample.runners_up) board.points_lidar_m = {};
  }
  return samples;
}

}  // namespace

std::optional<Finding> LikelyCause(const std::vector<BoardSample>& samples,
                                   const CalibrationTask& task) {
  constexpr std::size_t kFewestTried = 5;  // of fewer, three agree by chance
  constexpr double kLeastShare = 0.5;      // of the samples, that agree by the right answer...
  constexpr double kLeastGain = 0.3;       // ...and that did not before
  if (samples.size() < kFewestTried) return {};
  const GivenSession given{task.board, task.camera, WithoutPoints(samples)};
  const ConsistencyOptions& options = task.options.consistency;
  const std::size_t num_before = NumAgreeing(given.samples, options);
  const auto num_all = static_cast<double>(samples.size());
  std::size_t most = num_before + static_cast<std::size_t>(kLeastGain * num_all);
  std::optional<Finding> likely;
  for (const RigQuestion& question : QuestionsOf(given)) {
    GivenSession session = given;
    question.undo(&session);
    const std::size_t num = NumAgreeing(session.samples, options);
    if (num <= most || static_cast<double>(num) < kLeastShare * num_all) continue;
    most = num;
    likely.emplace();
    likely->cause = question.cause;
    likely->must_be_mended = true;
    likely->text =
        question.claim + "; " + question.remedy +
        Format(
            " (%zu of %zu samples agree then, %zu do as it is)", num, samples.size(), num_before);
  }
  return likely;
}

}  // namespace voqcal
