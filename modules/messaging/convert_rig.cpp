#include "messaging/convert_rig.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "messaging/convert_result.hpp"
#include "messaging/row_major.hpp"
#include "result/join_rig.hpp"

namespace voqcal {
namespace {

rig_pair_t PairMessage(const CalibratedPair& pair, const std::vector<PairInTree>& in_tree) {
  rig_pair_t message{};
  message.name = pair.Name();
  message.from = pair.extrinsic.from;
  message.to = pair.extrinsic.to;
  message.has_session = pair.HasSession() ? 1 : 0;
  message.samples_sha256 = pair.samples_sha256;
  message.num_samples = pair.num_samples;
  message.problem = pair.problem;
  message.T_to_from = ToMessage(pair.extrinsic.T_to_from);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) message.covariance[i][j] = pair.extrinsic.covariance(i, j);
  }
  message.sigma_rad = message.sigma_m = std::numeric_limits<double>::quiet_NaN();
  for (const PairInTree& each : in_tree) {
    if (each.name != message.name) continue;
    message.sigma_rad = each.sigma_rad;
    message.sigma_m = each.sigma_m;
  }
  if (pair.HasSession() && pair.problem.empty()) {
    message.verdict_grade = ToString(pair.verdict.grade);
    message.verdict_headline = pair.verdict.headline;
  }
  return message;
}

void FillTree(const RigExtrinsics& result, rig_extrinsics_t* message) {
  const SensorNetwork& network = result.network;
  const Verdict verdict = VerdictOf(result);
  message->verdict_grade = ToString(verdict.grade);
  message->verdict_headline = verdict.headline;
  for (const VerdictCheck& check : verdict.checks) {
    verdict_check_t& part = message->verdict_checks.emplace_back();
    part.name = check.name;
    part.grade = ToString(check.grade);
    part.text = check.text;
  }
  message->num_verdict_checks = static_cast<std::int32_t>(message->verdict_checks.size());
  message->reference = network.reference;
  for (std::size_t i = 0; i < network.sensors.size(); ++i) {
    rig_sensor_t sensor{};
    sensor.name = network.sensors[i];
    const bool is_lidar = std::count(result.lidars.begin(), result.lidars.end(), sensor.name) > 0;
    sensor.kind = is_lidar ? "lidar" : "camera";
    sensor.T_reference_sensor = ToMessage(network.T_reference_sensor[i]);
    message->sensors.push_back(sensor);
  }
  message->num_sensors = static_cast<std::int32_t>(message->sensors.size());
  const Eigen::MatrixXd& covariance = network.covariance;
  message->num_rows = static_cast<std::int32_t>(covariance.rows());
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    std::vector<double>& row = message->covariance.emplace_back();
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) row.push_back(covariance(i, j));
  }
}

}  // namespace

rig_extrinsics_t ToMessage(const RigExtrinsics& result) {
  rig_extrinsics_t message{};
  const std::vector<PairInTree> in_tree = PairsInTree(result);
  message.problem = result.network.problem;
  if (result.network.IsUsable()) FillTree(result, &message);
  for (const CalibratedPair& pair : result.pairs) {
    message.pairs.push_back(PairMessage(pair, in_tree));
  }
  message.num_pairs = static_cast<std::int32_t>(message.pairs.size());
  return message;
}

PairNeed NeedOf(const rig_pair_t& pair, const next_pose_t* next) {
  PairNeed need;
  need.from = pair.from;
  need.to = pair.to;
  need.num_samples = pair.num_samples;
  for (const Grade grade : {Grade::kGood, Grade::kLook, Grade::kBad}) {
    if (pair.verdict_grade == ToString(grade)) need.grade = grade;
  }
  if (next != nullptr) {
    need.is_enough = next->is_enough != 0;
    need.has_place = next->problem.empty();
    need.worst_error = next->worst_error;
  }
  return need;
}

}  // namespace voqcal
