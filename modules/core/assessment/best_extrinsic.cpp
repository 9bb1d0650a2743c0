#include "core/assessment/best_extrinsic.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/likelihood/rig_errors.hpp"
#include "core/parallel.hpp"
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

// What the other poses give of one that is held out.
struct WithoutOne {
  RefinedExtrinsic reprojection;
  LikelihoodExtrinsic likelihood;
  MixedFit sightings;
};

std::vector<WithoutOne> LeaveOneOut(const std::vector<const BoardSample*>& samples,
                                    const CameraModel& camera,
                                    const Eigen::Isometry3d& T_camera_lidar_start,
                                    const LikelihoodExtrinsic& likelihood,
                                    const JointExtrinsic& joint,
                                    const RefinerOptions& options) {
  std::vector<WithoutOne> without(samples.size());
  ParallelFor(samples.size(), [&](std::size_t i) {
    std::vector<const BoardSample*> others = samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    without[i].reprojection =
        RefineExtrinsic(others, camera, T_camera_lidar_start, options.reprojection);
    if (likelihood.IsUsable()) {
      without[i].likelihood = RefineNearby(others, likelihood, options.likelihood);
    }
    if (joint.IsUsable()) without[i].sightings = FitNearby(others, camera, joint.sightings);
  });
  return without;
}

// Each sample scored by `score`, of what the others give; NaN where that is not usable.
template <typename Score>
SceneScore ScoreEach(const std::vector<const BoardSample*>& samples,
                     const std::vector<WithoutOne>& without,
                     const Score& score) {
  std::vector<PoseScore> poses;
  for (std::size_t i = 0; i < samples.size(); ++i) poses.push_back(score(*samples[i], without[i]));
  return SummariseScores(std::move(poses));
}

SceneScore ReprojectionHeldOut(const std::vector<const BoardSample*>& samples,
                               const std::vector<WithoutOne>& without,
                               const CameraModel& camera) {
  return ScoreEach(samples, without, [&](const BoardSample& sample, const WithoutOne& others) {
    if (!others.reprojection.IsUsable()) return PoseScore{};
    return ScorePose(sample, camera, others.reprojection.T_camera_lidar);
  });
}

// At a given extrinsic. The likelihood tells it from what the scan lines' offsets do to the lidar's
// planes; the sightings alone do not.
ChessboardTurn TurnAt(const LikelihoodExtrinsic& likelihood,
                      const MixedFit& sightings,
                      const Eigen::Isometry3d& T_camera_lidar) {
  return likelihood.IsUsable() ? likelihood.ChessboardTurnAt(T_camera_lidar)
                               : sightings.ChessboardTurnAt(T_camera_lidar);
}

SceneScore LikelihoodHeldOut(const std::vector<const BoardSample*>& samples,
                             const std::vector<WithoutOne>& without,
                             const CameraModel& camera) {
  return ScoreEach(samples, without, [&](const BoardSample& sample, const WithoutOne& others) {
    const LikelihoodExtrinsic& refined = others.likelihood;
    if (!refined.IsUsable()) return PoseScore{};
    return ScorePose(
        CorrectedSample(
            sample, refined.bias, refined.ChessboardTurnAt(refined.T_camera_lidar).value_rad),
        camera,
        refined.T_camera_lidar);
  });
}

SceneScore JointHeldOut(const std::vector<const BoardSample*>& samples,
                        const std::vector<WithoutOne>& without,
                        const CameraModel& camera,
                        const JointExtrinsic& joint) {
  return ScoreEach(samples, without, [&](const BoardSample& sample, const WithoutOne& others) {
    if (!others.sightings.is_usable) return PoseScore{};
    const bool has_likelihood = others.likelihood.IsUsable();
    const Eigen::Isometry3d T_camera_lidar =
        joint.Without(others.sightings, has_likelihood ? &others.likelihood : nullptr);
    const LidarBias bias = has_likelihood ? others.likelihood.BiasAt(T_camera_lidar) : LidarBias{};
    const Eigen::Vector2d turn_rad =
        TurnAt(others.likelihood, others.sightings, T_camera_lidar).value_rad;
    return ScorePose(CorrectedSample(sample, bias, turn_rad), camera, T_camera_lidar);
  });
}

// About the centre.
BoardPose TurnedBack(const BoardPose& pose, const Eigen::Vector2d& turn_rad) {
  const Eigen::Matrix3d back = ExpSO3({-turn_rad.x(), -turn_rad.y(), 0.0});
  BoardPose turned = pose;
  turned.normal = back * pose.normal;
  for (Eigen::Vector3d& corner_m : turned.corners_m) {
    corner_m = pose.centre_m + back * (corner_m - pose.centre_m);
  }
  return turned;
}

// The average is of the samples themselves, and the lidar's common offset, which they share.
Matrix6d CovarianceOfAverage(const std::vector<const BoardSample*>& samples,
                             const AveragedExtrinsic& average,
                             double range_offset_m) {
  Eigen::Vector3d along_view = Eigen::Vector3d::Zero();
  for (const BoardSample* sample : samples) {
    along_view += sample->camera.pose.centre_m.normalized() / static_cast<double>(samples.size());
  }
  Matrix6d covariance = average.spread.cwiseAbs2().asDiagonal();
  covariance.bottomRightCorner<3, 3>() +=
      range_offset_m * range_offset_m * along_view * along_view.transpose();
  return covariance;
}

// The named one; else the joint one; else the least error that is known. Without any score to go
// by, the average.
const MethodTrial& Choose(const std::vector<MethodTrial>& trials,
                          const std::optional<RefineMethod>& named) {
  const MethodTrial* best = &trials.front();
  for (const MethodTrial& trial : trials) {
    if (named && trial.method == *named) return trial;
    if (!named && trial.method == RefineMethod::kJoint && trial.problem.empty()) return trial;
    const bool is_better = std::isnan(best->ErrorMm()) ? !std::isnan(trial.ErrorMm())
                                                       : trial.ErrorMm() < best->ErrorMm();
    if (is_better) best = &trial;
  }
  return *best;
}

SceneScore NoScore(std::size_t num_samples) {
  return SummariseScores(std::vector<PoseScore>(num_samples));
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
    case RefineMethod::kJoint:
      return "joint";
  }
  throw std::logic_error("unknown RefineMethod");
}

std::optional<RefineMethod> RefineMethodFromString(const std::string& name) {
  for (const RefineMethod method : {RefineMethod::kAverage,
                                    RefineMethod::kReprojection,
                                    RefineMethod::kLikelihood,
                                    RefineMethod::kJoint}) {
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
  if (method == RefineMethod::kLikelihood) return likelihood.bias;
  return method == RefineMethod::kJoint ? likelihood.BiasAt(T_camera_lidar) : LidarBias{};
}

BoardSample CorrectedSample(const BoardSample& sample,
                            const LidarBias& bias,
                            const Eigen::Vector2d& chessboard_turn_rad) {
  BoardSample corrected;
  corrected.id = sample.id;
  corrected.utime = sample.utime;
  corrected.camera_utime = sample.camera_utime;
  corrected.num_frames = sample.num_frames;
  corrected.camera = sample.camera;
  corrected.camera.pose = TurnedBack(sample.camera.pose, chessboard_turn_rad);
  corrected.lidar.pose =
      bias.IsObservable() ? CorrectedPose(sample.lidar, bias) : sample.lidar.pose;
  corrected.lidar.sides = sample.lidar.sides;
  corrected.lidar.edge_lengths_m = sample.lidar.edge_lengths_m;
  return corrected;
}

std::vector<BoardSample> CorrectedSamples(const std::vector<const BoardSample*>& samples,
                                          const LidarBias& bias,
                                          const Eigen::Vector2d& chessboard_turn_rad) {
  std::vector<BoardSample> corrected;
  for (const BoardSample* sample : samples) {
    corrected.push_back(CorrectedSample(*sample, bias, chessboard_turn_rad));
  }
  return corrected;
}

SceneScore ScoreCorrected(const std::vector<const BoardSample*>& samples,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_lidar,
                          const LidarBias& bias,
                          const Eigen::Vector2d& chessboard_turn_rad) {
  std::vector<PoseScore> poses;
  for (const BoardSample& sample : CorrectedSamples(samples, bias, chessboard_turn_rad)) {
    poses.push_back(ScorePose(sample, camera, T_camera_lidar));
  }
  return SummariseScores(std::move(poses));
}

BestExtrinsic RefineBest(const std::vector<const BoardSample*>& samples,
                         const BoardSpec& board,
                         const CameraModel& camera,
                         const AveragedExtrinsic& average,
                         const std::vector<SceneView>& views,
                         const RefinerOptions& options) {
  RequireUsable("RefinerOptions", options.Problems());
  BestExtrinsic best;
  best.T_camera_lidar = average.T_camera_lidar;
  best.problem = VarietyProblem(samples);
  if (!best.problem.empty()) return best;

  const Eigen::Isometry3d& T_start = average.T_camera_lidar;
  const RefinedExtrinsic reprojection =
      RefineExtrinsic(samples, camera, T_start, options.reprojection);
  const bool has_points = MostHavePoints(samples);
  if (has_points) {
    best.likelihood = RefineByLikelihood(samples, T_start, options.likelihood);
  }
  best.joint = RefineJointly(samples,
                             T_start,
                             best.likelihood.IsUsable() ? &best.likelihood : nullptr,
                             views,
                             camera,
                             options.scene);
  best.trials = {
      {RefineMethod::kAverage, "", ScoreScene(samples, camera, T_start)},
      {RefineMethod::kReprojection, ProblemOf(reprojection.status), {}},
      {RefineMethod::kLikelihood,
       has_points ? ProblemOf(best.likelihood.status) : "most samples have no points of the board",
       {}},
      {RefineMethod::kJoint, best.joint.problem, {}}};
  const std::vector<WithoutOne> without =
      LeaveOneOut(samples, camera, T_start, best.likelihood, best.joint, options);
  if (reprojection.IsUsable()) {
    best.trials[1].held_out = ReprojectionHeldOut(samples, without, camera);
  }
  if (best.likelihood.IsUsable()) {
    best.trials[2].held_out = LikelihoodHeldOut(samples, without, camera);
  }
  if (best.joint.IsUsable()) {
    best.trials[3].held_out = JointHeldOut(samples, without, camera, best.joint);
  }

  const MethodTrial& chosen = Choose(best.trials, options.method);
  best.method = chosen.method;
  best.problem = chosen.problem;
  best.held_out = chosen.held_out;
  switch (chosen.method) {
    case RefineMethod::kAverage:
      best.covariance_given_rig =
          CovarianceOfAverage(samples, average, options.reprojection.range_offset_m);
      best.held_out = NoScore(samples.size());  // its trial's score is of its own samples
      break;
    case RefineMethod::kReprojection:
      best.T_camera_lidar = reprojection.T_camera_lidar;
      best.covariance_given_rig = reprojection.covariance;
      break;
    case RefineMethod::kLikelihood:
      best.T_camera_lidar = best.likelihood.T_camera_lidar;
      best.covariance_given_rig = best.likelihood.uncertainty.covariance;
      break;
    case RefineMethod::kJoint:
      best.T_camera_lidar = best.joint.T_camera_lidar();
      best.covariance_given_rig = best.joint.covariance();
      best.scene_note = best.joint.scene.reason;
      break;
  }
  if (best.likelihood.IsUsable()) {  // else it is not known what the rig file's errors do
    best.covariance =
        best.covariance_given_rig +
        CovarianceByRigErrors(samples, board, camera, best.likelihood, options.likelihood);
  }
  const bool is_turn_taken_out =
      best.method == RefineMethod::kLikelihood || best.method == RefineMethod::kJoint;
  if (best.IsUsable() && is_turn_taken_out) {
    best.chessboard_turn = TurnAt(best.likelihood, best.joint.sightings, best.T_camera_lidar);
  }
  best.reprojection_rms_px = CentreRmsPx(ScoreScene(samples, camera, best.T_camera_lidar));
  return best;
}

}  // namespace voqcal
