#include "messaging/convert_result.hpp"
#include "messaging/message_error.hpp"
#include "messaging/row_major.hpp"

namespace voqcal {
namespace {

bias_estimate_t ToMessage(const BiasEstimate& estimate) {
  bias_estimate_t message{};
  message.value_m = estimate.value_m;
  message.standard_error_m = estimate.standard_error_m;
  message.is_observable = estimate.is_observable ? 1 : 0;
  return message;
}

BiasEstimate FromMessage(const bias_estimate_t& message) {
  return {message.value_m, message.standard_error_m, message.is_observable != 0};
}

RefineMethod MethodFromString(const std::string& name) {
  const std::optional<RefineMethod> method = RefineMethodFromString(name);
  if (!method) throw MessageError("refined extrinsic message: unknown method '" + name + "'");
  return *method;
}

method_trial_t ToMessage(const MethodTrial& trial) {
  method_trial_t message{};
  message.method = ToString(trial.method);
  message.problem = trial.problem;
  message.held_out = ToMessage(trial.held_out);
  message.error_mm = trial.ErrorMm();
  return message;
}

MethodTrial FromMessage(const method_trial_t& message) {
  return {MethodFromString(message.method), message.problem, FromMessage(message.held_out)};
}

}  // namespace

lidar_bias_t ToMessage(const LidarBias& bias) {
  lidar_bias_t message{};
  message.common = ToMessage(bias.common);
  message.dark_step = ToMessage(bias.dark_step);
  message.outline_lift = ToMessage(bias.outline_lift);
  message.outline_rise = ToMessage(bias.outline_rise);
  for (const BiasEstimate& ring : bias.rings) message.rings.push_back(ToMessage(ring));
  message.num_rings = static_cast<std::int32_t>(message.rings.size());
  message.dark_intensity = bias.shades.dark_intensity;
  message.bright_intensity = bias.shades.bright_intensity;
  return message;
}

LidarBias FromMessage(const lidar_bias_t& message) {
  LidarBias bias;
  bias.common = FromMessage(message.common);
  bias.dark_step = FromMessage(message.dark_step);
  bias.outline_lift = FromMessage(message.outline_lift);
  bias.outline_rise = FromMessage(message.outline_rise);
  for (const bias_estimate_t& ring : message.rings) bias.rings.push_back(FromMessage(ring));
  bias.shades = {message.dark_intensity, message.bright_intensity};
  return bias;
}

pose_score_t ToMessage(const PoseScore& score) {
  pose_score_t message{};
  message.centre_px = score.centre_px;
  message.centre_mm = score.centre_mm;
  message.corner_mm = score.corner_mm;
  message.normal_deg = score.normal_deg;
  return message;
}

PoseScore FromMessage(const pose_score_t& message) {
  return {message.centre_px, message.centre_mm, message.corner_mm, message.normal_deg};
}

extrinsic_refined_t ToMessage(const BestExtrinsic& best,
                              const std::vector<std::int64_t>& sample_ids) {
  extrinsic_refined_t message{};
  message.problem = best.problem;
  message.T_camera_lidar = ToMessage(best.T_camera_lidar);
  message.method = ToString(best.method);
  message.scene = best.scene_note;
  Eigen::Map<RowMajor6d>(&message.covariance[0][0]) = best.covariance;
  Eigen::Map<RowMajor6d>(&message.covariance_given_rig[0][0]) = best.covariance_given_rig;
  message.reprojection_rms_px = best.reprojection_rms_px;
  message.sample_ids = sample_ids;
  message.num_samples = static_cast<std::int32_t>(sample_ids.size());
  for (const PoseScore& pose : best.held_out.poses) message.held_out.push_back(ToMessage(pose));
  message.held_out.resize(sample_ids.size(), ToMessage(PoseScore{}));
  for (const MethodTrial& trial : best.trials) message.trials.push_back(ToMessage(trial));
  message.num_trials = static_cast<std::int32_t>(message.trials.size());
  message.lidar_bias = ToMessage(best.Bias());
  Eigen::Map<Eigen::Vector2d>(message.chessboard_turn_rad) = best.chessboard_turn.value_rad;
  Eigen::Map<Eigen::Vector2d>(message.chessboard_turn_error_rad) =
      best.chessboard_turn.standard_error_rad;
  const bool is_likelihood = best.method == RefineMethod::kLikelihood;
  const LikelihoodExtrinsic likelihood = is_likelihood ? best.likelihood : LikelihoodExtrinsic{};
  const LikelihoodUncertainty& uncertainty = likelihood.uncertainty;
  Eigen::Map<Vector6d>(message.sigma_by_likelihood) = uncertainty.by_likelihood;
  Eigen::Map<Vector6d>(message.sigma_by_resampling) = uncertainty.by_resampling;
  const LikelihoodNoise& noise = likelihood.noise;
  message.range_noise_m = noise.range_m;
  message.along_ray_error_m = noise.along_ray_m;
  message.across_ray_error_m = noise.across_ray_m;
  message.tilt_error_rad = noise.tilt_rad;
  message.turn_error_rad = noise.turn_rad;
  return message;
}

BestExtrinsic FromMessage(const extrinsic_refined_t& message) {
  BestExtrinsic best;
  best.problem = message.problem;
  best.T_camera_lidar = FromMessage(message.T_camera_lidar);
  best.method = MethodFromString(message.method);
  best.scene_note = message.scene;
  best.covariance = Eigen::Map<const RowMajor6d>(&message.covariance[0][0]);
  best.covariance_given_rig = Eigen::Map<const RowMajor6d>(&message.covariance_given_rig[0][0]);
  best.reprojection_rms_px = message.reprojection_rms_px;
  std::vector<PoseScore> poses;
  for (const pose_score_t& pose : message.held_out) poses.push_back(FromMessage(pose));
  best.held_out = SummariseScores(std::move(poses));
  for (const method_trial_t& trial : message.trials) best.trials.push_back(FromMessage(trial));
  best.likelihood.T_camera_lidar = best.T_camera_lidar;
  best.likelihood.bias = FromMessage(message.lidar_bias);
  best.chessboard_turn = {Eigen::Map<const Eigen::Vector2d>(message.chessboard_turn_rad),
                          Eigen::Map<const Eigen::Vector2d>(message.chessboard_turn_error_rad)};
  best.likelihood.noise = {message.range_noise_m,
                           message.along_ray_error_m,
                           message.across_ray_error_m,
                           message.tilt_error_rad,
                           message.turn_error_rad};
  LikelihoodUncertainty& uncertainty = best.likelihood.uncertainty;
  uncertainty.by_likelihood = Eigen::Map<const Vector6d>(message.sigma_by_likelihood);
  uncertainty.by_resampling = Eigen::Map<const Vector6d>(message.sigma_by_resampling);
  uncertainty.covariance = best.covariance_given_rig;
  return best;
}

}  // namespace voqcal
