#include <array>
#include <functional>

#include "core/calibration/calibrate.hpp"
#include "core/calibration/likely_cause.hpp"
#include "core/parallel.hpp"
#include "core/selection/voq.hpp"

namespace voqcal {
namespace {

AveragedPart PartOf(const AveragedExtrinsic& average) {
  AveragedPart part;
  part.T_camera_lidar = average.T_camera_lidar;
  part.spread = average.spread;
  part.num_sets = static_cast<int>(average.is_kept.size());
  part.num_kept = average.num_kept;
  return part;
}

Enough EnoughOf(std::size_t num_used, const Calibration& calibration, const CalibrationTask& task) {
  const EnoughOptions& options = task.options.enough;
  const ErrorScene scene(task.camera, calibration.T_camera_lidar, options.tolerance);
  return JudgeEnough(
      static_cast<int>(num_used), scene.Worst(calibration.covariance_given_rig), options);
}

/// Lens against lens: another method's scores would be compared with the likelihood's.
LensCorrection LensCorrectionOf(const std::vector<const BoardSample*>& used,
                                const std::vector<MethodTrial>& trials,
                                const Eigen::Isometry3d& T_camera_lidar,
                                const CalibrationTask& task) {
  for (const MethodTrial& trial : trials) {
    if (trial.method != RefineMethod::kLikelihood || !trial.problem.empty()) continue;
    return CorrectLens(used,
                       task.board,
                       task.camera,
                       T_camera_lidar,
                       trial.held_out,
                       task.options.refinement.likelihood);
  }
  return {};
}

/// Where many samples were left out: what would make them agree comes before what is said of the
/// others, unless that makes the result wrong by the likelihood of all that they tell.
void AddLikelyCause(const ChosenSamples& chosen,
                    const CalibrationTask& task,
                    Diagnosis* diagnosis) {
  constexpr double kMany = 0.15;  // of the samples
  const auto num_left_out = static_cast<double>(chosen.rejected.size());
  if (num_left_out <= kMany * static_cast<double>(chosen.samples.size())) return;
  const auto likely = LikelyCause(chosen.samples, task);
  auto at = diagnosis->findings.begin();
  while (at != diagnosis->findings.end() && at->must_be_mended) ++at;
  if (likely) diagnosis->findings.insert(at, *likely);
}

}  // namespace

Calibration Assess(const ChosenSamples& chosen,
                   const AveragedExtrinsic& average,
                   const BestExtrinsic& refined,
                   const SceneViewsOf& scene_views,
                   const CalibrationTask& task) {
  const std::vector<const BoardSample*> used = chosen.Used();
  const CameraModel& camera = task.camera;
  Calibration result;
  result.T_camera_lidar = refined.T_camera_lidar;
  result.covariance = refined.covariance;
  result.covariance_given_rig = refined.covariance_given_rig;
  result.method = refined.method;
  result.scene_note = refined.scene_note;
  result.trials = refined.trials;
  result.lidar_bias = refined.Bias();
  result.chessboard_turn = refined.chessboard_turn;
  result.averaged = PartOf(average);
  result.held_out = refined.held_out;
  result.in_sample = ScoreCorrected(
      used, camera, result.T_camera_lidar, result.lidar_bias, result.chessboard_turn.value_rad);
  result.of_average = ScoreScene(used, camera, average.T_camera_lidar);
  result.held_out_by_cell = BinByImageCell(used, result.held_out, camera);
  result.held_out_by_range = BinByRange(used, result.held_out);
  result.predicted = PredictErrors(result.T_camera_lidar, result.covariance_given_rig, camera);
  result.enough = EnoughOf(used.size(), result, task);
  const std::array<std::function<void()>, 3> judgements = {
      [&] {
        result.scene_check = CheckScene(scene_views ? scene_views(used) : std::vector<SceneView>(),
                                        camera,
                                        result.T_camera_lidar,
                                        task.options.scene_check);
      },
      [&] {
        result.lens_correction = LensCorrectionOf(used, result.trials, result.T_camera_lidar, task);
      },
      [&] {
        result.diagnosis = Diagnose(used,
                                    static_cast<int>(chosen.rejected.size()),
                                    task.board,
                                    camera,
                                    result.T_camera_lidar,
                                    result.covariance_given_rig,
                                    result.lidar_bias.common,
                                    task.options.diagnosis);
        AddLikelyCause(chosen, task, &result.diagnosis);
      }};
  ParallelFor(judgements.size(), [&](std::size_t i) { judgements[i](); });
  result.e_dim_mm = MedianBoardDimensionErrorMm(chosen.samples, task.board);
  result.used_ids = IdsOf(used);
  result.rejected = chosen.rejected;
  result.exchanged = chosen.exchanged;
  return result;
}

}  // namespace voqcal
