#include "core/assessment/best_extrinsic.hpp"

#include <cmath>
#include <stdexcept>

#include "core/problems.hpp"
#include "core/selection/pose_variety.hpp"

namespace voqcal {
namespace {

bool MostHavePoints(const std::vector<const BoardSample*>& samples) {
  constexpr std::size_t kMinPoints = 30;  // a plane needs some
  std::size_t num = 0;
  for (const BoardSample* sample : samples) {
    num += sample->lidar.points_lidar_m.points.size() >= kMinPoints ? 1 : 0;
  }
  return 2 * num > samples.size();
}

std::string ProblemOf(RefineStatus status) {
  return status == RefineStatus::kConverged ? "" : "the refinement is " + ToString(status);
}

SceneScore LikelihoodHeldOut(const std::vector<const BoardSample*>& samples,
                             const CameraModel& camera,
                             const LikelihoodExtrinsic& all,
                             const LikelihoodOptions& options) {
  return ScoreHeldOut(samples, [&](const BoardSample& held_out, const auto& others) -> PoseScore {
    const LikelihoodExtrinsic refined = RefineNearby(others, all, options);
    if (!refined.IsUsable()) return {};
    return ScorePose(CorrectedSample(held_out, refined.bias), camera, refined.T_camera_lidar);
  });
}

MethodTrial TryAverage(const std::vector<const BoardSample*>& samples,
                       const CameraModel& camera,
                       const AveragedExtrinsic& average) {
  return {RefineMethod::kAverage, "", ScoreScene(samples, camera, average.T_camera_lidar)};
}

MethodTrial TryReprojection(const std::vector<const BoardSample*>& samples,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar_start,
                            const RefineOptions& options,
                            RefinedExtrinsic* refined) {
  MethodTrial trial{RefineMethod::kReprojection, "", {}};
  *refined = RefineExtrinsic(samples, camera, T_camera_lidar_start, options);
  trial.problem = ProblemOf(refined->status);
  if (refined->IsUsable()) {
    trial.held_out = LeaveOneOutScore(samples, camera, T_camera_lidar_start, options);
  }
  return trial;
}

MethodTrial TryLikelihood(const std::vector<const BoardSample*>& samples,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_lidar_start,
                          const LikelihoodOptions& options,
                          LikelihoodExtrinsic* refined) {
  MethodTrial trial{RefineMethod::kLikelihood, "", {}};
  if (!MostHavePoints(samples)) {
    trial.problem = "most samples have no points of the board";
    return trial;
  }
  *refined = RefineByLikelihood(samples, camera, T_camera_lidar_start, options);
  trial.problem = ProblemOf(refined->status);
  if (refined->IsUsable()) {
    trial.held_out = LikelihoodHeldOut(samples, camera, *refined, options);
  }
  return trial;
}

// The named one; else the least error. Without any score to go by, the average.
const MethodTrial& Choose(const std::vector<MethodTrial>& trials,
                          const std::optional<RefineMethod>& named) {
  const MethodTrial* best = &trials.front();
  for (const MethodTrial& trial : trials) {
    if (named && trial.method == *named) return trial;
    if (trial.ErrorMm() < best->ErrorMm()) best = &trial;
  }
  return *best;
}

double CentreRmsPx(const SceneScore& scene) {
  return std::hypot(scene.centre_px.mean, scene.centre_px.std);
}

}  // namespace

std::string ToString(RefineMethod method) {
  switch (method) {
    case RefineMethod::kAverage:
      return "average";
    case RefineMethod::kReprojection:
      return "reprojection";
    case RefineMethod::kLikelihood:
      return "likelihood";
  }
  throw std::logic_error("unknown RefineMethod");
}

std::optional<RefineMethod> RefineMethodFromString(const std::string& name) {
  for (const RefineMethod method :
       {RefineMethod::kAverage, RefineMethod::kReprojection, RefineMethod::kLikelihood}) {
    if (name == ToString(method)) return method;
  }
  return {};
}

std::vector<std::string> RefinerOptions::Problems() const {
  ProblemList problems;
  problems.Add(reprojection.Problems());
  problems.Add(likelihood.Problems());
  problems.Add(scene.Problems());
  return problems.lines();
}

LidarBias BestExtrinsic::Bias() const {
  return method == RefineMethod::kLikelihood ? likelihood.bias : LidarBias{};
}

BoardSample CorrectedSample(const BoardSample& sample, const LidarBias& bias) {
  BoardSample corrected;
  corrected.id = sample.id;
  corrected.utime = sample.utime;
  corrected.camera_utime = sample.camera_utime;
  corrected.num_frames = sample.num_frames;
  corrected.camera = sample.camera;
  corrected.lidar.pose = CorrectedPose(sample.lidar, bias);
  corrected.lidar.edge_lengths_m = sample.lidar.edge_lengths_m;
  return corrected;
}

std::vector<BoardSample> CorrectedSamples(const std::vector<const BoardSample*>& samples,
                                          const LidarBias& bias) {
  std::vector<BoardSample> corrected;
  for (const BoardSample* sample : samples) {
    corrected.push_back(bias.IsObservable() ? CorrectedSample(*sample, bias) : *sample);
  }
  return corrected;
}

SceneScore ScoreCorrected(const std::vector<const BoardSample*>& samples,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_lidar,
                          const LidarBias& bias) {
  std::vector<PoseScore> poses;
  for (const BoardSample& sample : CorrectedSamples(samples, bias)) {
    poses.push_back(ScorePose(sample, camera, T_camera_lidar));
  }
  return SummariseScores(std::move(poses));
}

BestExtrinsic RefineBest(const std::vector<const BoardSample*>& samples,
                         const CameraModel& camera,
                         const AveragedExtrinsic& average,
                         const RefinerOptions& options) {
  RequireUsable("RefinerOptions", options.Problems());
  BestExtrinsic best;
  best.T_camera_lidar = average.T_camera_lidar;
  best.problem = VarietyProblem(samples);
  if (!best.problem.empty()) return best;

  RefinedExtrinsic reprojection;
  const Eigen::Isometry3d& T_start = average.T_camera_lidar;
  best.trials = {TryAverage(samples, camera, average),
                 TryReprojection(samples, camera, T_start, options.reprojection, &reprojection),
                 TryLikelihood(samples, camera, T_start, options.likelihood, &best.likelihood)};
  const MethodTrial& chosen = Choose(best.trials, options.method);
  best.method = chosen.method;
  best.problem = chosen.problem;
  best.held_out = chosen.held_out;
  switch (chosen.method) {
    case RefineMethod::kAverage:
      best.covariance = average.spread.cwiseAbs2().asDiagonal();
      break;
    case RefineMethod::kReprojection:
      best.T_camera_lidar = reprojection.T_camera_lidar;
      best.covariance = reprojection.covariance;
      break;
    case RefineMethod::kLikelihood:
      best.T_camera_lidar = best.likelihood.T_camera_lidar;
      best.covariance = best.likelihood.uncertainty.covariance;
      break;
  }
  best.reprojection_rms_px = CentreRmsPx(ScoreScene(samples, camera, best.T_camera_lidar));
  return best;
}

}  // namespace voqcal
