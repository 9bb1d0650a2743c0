#include "extrinsic_estimator/extrinsic_estimator_node.hpp"

#include <vector>

#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"

namespace voqcal {

ExtrinsicEstimatorNode::ExtrinsicEstimatorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Keep(rig_.channels.calib_samples, &samples_);
  bus_.Keep(rig_.channels.voq_sets, &sets_);
}

std::string ExtrinsicEstimatorNode::State() const {
  if (!result_) return "waiting for samples and sets";
  return result_->problem.empty() ? "running" : "waiting: " + result_->problem;
}

bool ExtrinsicEstimatorNode::Step() {
  if (!samples_ || !sets_ || !IsMadeFrom(*samples_, *sets_)) return false;
  if (result_ && IsMadeFrom(*samples_, *result_)) return false;
  if (!CanRead([this] { result_ = Estimate(); })) {
    samples_.reset();
    return false;
  }
  Count(result_->problem.empty() ? "estimates" : "without a result");
  Republish();
  return false;
}

void ExtrinsicEstimatorNode::Republish() {
  if (result_) bus_.Publish(rig_.channels.extrinsic_averaged, *result_);
}

extrinsic_averaged_t ExtrinsicEstimatorNode::Estimate() const {
  extrinsic_averaged_t result{};
  std::string problem = sets_->problem;
  if (problem.empty()) {
    const std::vector<SetExtrinsic> extrinsics = CalibrateSets();
    const AveragedExtrinsic averaged = AverageExtrinsics(extrinsics, rig_.average);
    result = ToMessage(averaged, sets_->sets, extrinsics);
    if (!averaged.IsUsable()) problem = "no set of samples gives an extrinsic";
  }
  StampMadeFrom(*samples_, &result);
  result.problem = problem;
  result.num_inconsistent = sets_->num_inconsistent;
  result.inconsistent_ids = sets_->inconsistent_ids;
  result.inconsistent_reasons = sets_->inconsistent_reasons;
  result.num_chosen = sets_->num_chosen;
  result.chosen = sets_->chosen;
  return result;
}

std::vector<SetExtrinsic> ExtrinsicEstimatorNode::CalibrateSets() const {
  const std::vector<BoardSample> samples = SamplesAsChosen(*samples_, sets_->chosen);
  const std::vector<std::int64_t> ids = IdsOf(SamplesWithout(samples, {}));
  std::vector<SetExtrinsic> extrinsics;
  for (const voq_set_t& message : sets_->sets) {
    std::vector<const BoardSample*> set;
    for (const int index : FromMessage(message, ids).samples) {
      set.push_back(&samples[static_cast<std::size_t>(index)]);
    }
    extrinsics.push_back(EstimateSetExtrinsic(set, rig_.camera, rig_.extrinsic_estimator));
  }
  return extrinsics;
}

}  // namespace voqcal
