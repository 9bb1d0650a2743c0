#include "core/assessment/judge_questions.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "core/assessment/rig_questions.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::vector<const BoardSample*> PointersTo(const std::vector<BoardSample>& samples) {
  std::vector<const BoardSample*> pointers;
  for (const BoardSample& sample : samples) pointers.push_back(&sample);
  return pointers;
}

// Boards alone are asked about: the points would only be copied.
GivenSession SessionOf(const std::vector<const BoardSample*>& samples,
                       const BoardSpec& board,
                       const CameraModel& camera) {
  GivenSession session{board, camera, {}};
  for (const BoardSample* sample : samples) {
    session.samples.push_back(*sample);
    session.samples.back().lidar.points_lidar_m = {};
    session.samples.back().runners_up.clear();
  }
  return session;
}

/// What a session would be calibrated to.
struct Answer {
  FaultFit fit;
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  std::size_t num_samples = 0;
};

std::optional<Answer> AnswerOf(const GivenSession& session,
                               const std::vector<FaultParameter>& known) {
  constexpr int kNumRounds = 2;  // residuals are linear about each start
  Answer answer;
  const std::vector<const BoardSample*> samples = PointersTo(session.samples);
  answer.T_camera_lidar = AnalyticExtrinsic(samples);
  answer.num_samples = samples.size();
  for (int round = 0; round < kNumRounds; ++round) {
    const auto equations =
        MakeFaultEquations(samples, session.board, session.camera, answer.T_camera_lidar);
    answer.fit = FitFaults(equations, known);
    if (!answer.fit.is_usable) return std::nullopt;
    answer.T_camera_lidar = PerturbLeft(answer.T_camera_lidar, answer.fit.value.head<6>());
  }
  return answer;
}

Finding MakeFinding(const RigQuestion& question,
                    const Answer& answer,
                    const FaultFit& plain,
                    const Eigen::Isometry3d& T_plain,
                    const Matrix6d& covariance,
                    double gain) {
  const Vector6d move = DifferenceLeft(T_plain, answer.T_camera_lidar);
  Finding finding;
  finding.cause = question.cause;
  finding.must_be_mended = true;
  finding.log_likelihood_gain = gain;
  finding.moved_intervals = IntervalsOf(move, covariance);
  finding.held_out_before_mm = kMmPerM * plain.mean_held_out_error_m;
  finding.held_out_after_mm = kMmPerM * answer.fit.mean_held_out_error_m;
  finding.text = question.claim + "; " + MoveText(move, covariance) + "; " + question.remedy +
                 Format(" (held out, the centres' error in space falls from %.1f to %.1f mm)",
                        finding.held_out_before_mm,
                        finding.held_out_after_mm);
  return finding;
}

}  // namespace

void JudgeQuestions(const std::vector<const BoardSample*>& samples,
                    const FaultFit& plain,
                    const std::vector<FaultParameter>& known,
                    const JudgedResult& result,
                    const DiagnosisOptions& options,
                    Diagnosis* diagnosis) {
  constexpr std::size_t kLeastSamples = 5;
  constexpr double kLeastShare = 0.8;  // of the samples, that must make sense
  constexpr double kMostWorse = 1.1;   // how a pattern is turned says nothing of its centre
  if (!plain.is_usable || samples.size() < kLeastSamples) return;
  const GivenSession given = SessionOf(samples, result.board, result.camera);
  const Eigen::Isometry3d T_plain = PerturbLeft(result.T_camera_lidar, plain.value.head<6>());
  const double num = static_cast<double>(samples.size());
  std::optional<Finding> best;
  for (const RigQuestion& question : QuestionsAbout(result.board, result.camera)) {
    GivenSession session = given;
    question.undo(&session);
    if (static_cast<double>(session.samples.size()) < kLeastShare * num) continue;
    const auto answer = AnswerOf(session, known);
    if (!answer) continue;
    const double gain =
        num / static_cast<double>(answer->num_samples) * answer->fit.log_likelihood -
        plain.log_likelihood;
    if (gain < options.min_log_likelihood_gain) continue;
    if (best && gain < best->log_likelihood_gain) continue;
    if (answer->fit.mean_held_out_error_m > kMostWorse * plain.mean_held_out_error_m) continue;
    best = MakeFinding(question, *answer, plain, T_plain, result.covariance, gain);
  }
  if (best) diagnosis->findings.push_back(*best);
}

}  // namespace voqcal
