#include "messaging/convert_assessment.hpp"

#include <cstdint>

#include "messaging/convert_result.hpp"

namespace voqcal {

score_bin_t ToMessage(const ScoreBin& bin) {
  score_bin_t message{};
  message.name = bin.name;
  message.num_samples = static_cast<std::int32_t>(bin.score.poses.size());
  message.score = ToMessage(bin.score);
  return message;
}

predicted_error_t ToMessage(const PredictedError& error) {
  predicted_error_t message{};
  message.range_m = error.range_m;
  message.centre_px = error.centre_px;
  message.centre_mm = error.centre_mm;
  message.corner_px = error.corner_px;
  message.corner_mm = error.corner_mm;
  return message;
}

scene_check_t ToMessage(const SceneCheck& check) {
  scene_check_t message{};
  message.verdict = ToString(check.verdict);
  message.reason = check.reason;
  message.num_scenes = check.num_scenes;
  message.num_edges = check.num_edges;
  message.score = check.score;
  message.asked_score = check.asked_score;
  Eigen::Map<Vector6d>(message.asked) = check.asked;
  Eigen::Map<Vector6d>(message.sigma) = check.sigma;
  for (std::size_t i = 0; i < check.axes.size(); ++i) message.axes[i] = ToString(check.axes[i]);
  for (const SceneProbe& probe : check.probes) {
    scene_probe_t each{};
    Eigen::Map<Vector6d>(each.delta) = probe.delta;
    each.score = probe.score;
    message.probes.push_back(each);
  }
  message.num_probes = static_cast<std::int32_t>(message.probes.size());
  return message;
}

finding_t ToMessage(const Finding& finding) {
  finding_t message{};
  message.cause = finding.cause;
  message.text = finding.text;
  message.is_dealt_with = finding.is_dealt_with ? 1 : 0;
  message.value = finding.value;
  message.standard_error = finding.standard_error;
  message.unit = finding.unit;
  message.log_likelihood_gain = finding.log_likelihood_gain;
  message.explained = finding.explained;
  message.held_out_before_mm = finding.held_out_before_mm;
  message.held_out_after_mm = finding.held_out_after_mm;
  return message;
}

verdict_check_t ToMessage(const VerdictCheck& check) {
  verdict_check_t message{};
  message.name = check.name;
  message.grade = ToString(check.grade);
  message.text = check.text;
  return message;
}

}  // namespace voqcal
