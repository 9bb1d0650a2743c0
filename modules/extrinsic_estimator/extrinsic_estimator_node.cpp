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
    const AveragedSets averaged = Average();
    result = ToMessage(averaged.average, sets_->sets, averaged.extrinsics);
    problem = averaged.problem;
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

AveragedSets ExtrinsicEstimatorNode::Average() const {
  const std::vector<BoardSample> samples = SamplesAsChosen(*samples_, sets_->chosen);
  const std::vector<const BoardSample*> used = SamplesWithout(samples, sets_->inconsistent_ids);
  const std::vector<std::int64_t> ids = IdsOf(used);
  std::vector<VoqSet> sets;
  for (const voq_set_t& message : sets_->sets) sets.push_back(FromMessage(message, ids));
  return AverageSets(used, sets, rig_.Task());
}

}  // namespace voqcal
