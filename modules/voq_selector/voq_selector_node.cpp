#include "voq_selector/voq_selector_node.hpp"

#include <vector>

#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"

namespace voqcal {
namespace {

std::int64_t NumCombinationsOfThree(std::int64_t n) { return n * (n - 1) * (n - 2) / 6; }

// What became of the samples that do not fit the others as they are.
void AddFates(const ChosenSamples& chosen, voq_sets_t* result) {
  for (const RejectedSample& each : chosen.rejected) {
    result->inconsistent_ids.push_back(each.id);
    result->inconsistent_reasons.push_back(each.reason);
  }
  result->num_inconsistent = static_cast<std::int32_t>(result->inconsistent_ids.size());
  for (const ExchangedSample& each : chosen.exchanged) result->chosen.push_back(ToMessage(each));
  result->num_chosen = static_cast<std::int32_t>(result->chosen.size());
}

}  // namespace

VoqSelectorNode::VoqSelectorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Keep(rig_.channels.calib_samples, &samples_);
}

std::string VoqSelectorNode::State() const {
  if (!result_) return "waiting for samples";
  return result_->problem.empty() ? "running" : "waiting: " + result_->problem;
}

bool VoqSelectorNode::Step() {
  if (!samples_ || (result_ && IsMadeFrom(*samples_, *result_))) return false;
  if (!CanRead([this] { result_ = Select(*samples_); })) {
    samples_.reset();
    return false;
  }
  Count(result_->problem.empty() ? "selections" : "without a result");
  Republish();
  return false;
}

void VoqSelectorNode::Republish() {
  if (result_) bus_.Publish(rig_.channels.voq_sets, *result_);
}

voq_sets_t VoqSelectorNode::Select(const samples_t& message) const {
  voq_sets_t result{};
  StampMadeFrom(message, &result);
  result.criterion = ToString(rig_.voq_selector.criterion);
  const CalibrationTask task = rig_.Task();
  const ChosenSamples chosen =
      ChooseSamples(FromMessage(message), task.camera, task.options.consistency);
  AddFates(chosen, &result);

  const std::vector<std::int64_t> ids = IdsOf(chosen.Used());
  result.num_combinations = NumCombinationsOfThree(static_cast<std::int64_t>(ids.size()));
  const ChosenSets sets = ChooseSets(chosen, task);
  for (const VoqSet& set : sets.sets) result.sets.push_back(ToMessage(set, ids));
  result.num_sets = static_cast<std::int32_t>(result.sets.size());
  for (const VoqSet& set : sets.lowest_voq) result.lowest_voq.push_back(ToMessage(set, ids));
  result.num_lowest_voq = static_cast<std::int32_t>(result.lowest_voq.size());
  result.problem = sets.problem;
  return result;
}

}  // namespace voqcal
