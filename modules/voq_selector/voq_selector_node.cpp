#include "voq_selector/voq_selector_node.hpp"

#include <vector>

#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"

namespace voqcal {
namespace {

std::int64_t NumCombinationsOfThree(std::int64_t n) { return n * (n - 1) * (n - 2) / 6; }

// What became of the samples that do not fit the others as they are.
void AddVerdicts(const std::vector<BoardSample>& samples,
                 const Consistency& consistency,
                 voq_sets_t* result) {
  const std::vector<std::int64_t> ids = IdsOf(SamplesWithout(samples, {}));
  for (const InconsistentSample& each : consistency.inconsistent) {
    result->inconsistent_ids.push_back(ids[static_cast<std::size_t>(each.sample)]);
    result->inconsistent_reasons.push_back(each.reason);
  }
  result->num_inconsistent = static_cast<std::int32_t>(result->inconsistent_ids.size());
  for (const ChosenCandidate& each : consistency.chosen) {
    result->chosen.push_back(ToMessage(each, ids));
  }
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
  const std::vector<BoardSample> samples = FromMessage(message);
  const Consistency consistency = FindConsistent(samples, rig_.consistency);
  AddVerdicts(samples, consistency, &result);

  const std::vector<BoardSample> consistent = ConsistentSamples(samples, consistency);
  result.num_combinations = NumCombinationsOfThree(static_cast<std::int64_t>(consistent.size()));
  if (consistent.size() < 3) {
    result.problem = "fewer than three samples that agree with each other: " +
                     std::to_string(consistent.size()) + " of " + std::to_string(samples.size());
    return result;
  }
  const std::vector<std::int64_t> ids = IdsOf(SamplesWithout(consistent, {}));
  for (const VoqSet& set : SelectSets(consistent, rig_.board, rig_.camera, rig_.voq_selector)) {
    result.sets.push_back(ToMessage(set, ids));
  }
  result.num_sets = static_cast<std::int32_t>(result.sets.size());
  for (const VoqSet& set : SelectByVoq(consistent, rig_.board, rig_.voq_selector.num_sets)) {
    result.lowest_voq.push_back(ToMessage(set, ids));
  }
  result.num_lowest_voq = static_cast<std::int32_t>(result.lowest_voq.size());
  if (result.sets.empty()) result.problem = "all boards face the same way: tilt it differently";
  return result;
}

}  // namespace voqcal
