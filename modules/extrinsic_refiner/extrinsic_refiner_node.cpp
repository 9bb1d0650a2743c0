#include "extrinsic_refiner/extrinsic_refiner_node.hpp"

#include <utility>
#include <vector>

#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"

namespace voqcal {

ExtrinsicRefinerNode::ExtrinsicRefinerNode(const Rig& rig, Bus* bus, SceneViewsOf scene_views)
    : rig_(rig), bus_(*bus), scene_views_(std::move(scene_views)) {
  bus_.Keep(rig_.channels.calib_samples, &samples_);
  bus_.Keep(rig_.channels.extrinsic_averaged, &averaged_);
}

std::string ExtrinsicRefinerNode::State() const {
  if (!result_) return "waiting for samples and their average";
  return result_->problem.empty() ? "running" : "waiting: " + result_->problem;
}

bool ExtrinsicRefinerNode::Step() {
  if (!samples_ || !averaged_ || !IsMadeFrom(*samples_, *averaged_)) return false;
  if (result_ && IsMadeFrom(*samples_, *result_)) return false;
  if (!CanRead([this] { result_ = Refine(); })) {
    samples_.reset();
    return false;
  }
  Count(result_->problem.empty() ? "refinements" : "without a result");
  Republish();
  return false;
}

void ExtrinsicRefinerNode::Republish() {
  if (result_) bus_.Publish(rig_.channels.extrinsic_refined, *result_);
}

extrinsic_refined_t ExtrinsicRefinerNode::Refine() const {
  extrinsic_refined_t result{};
  result.problem = averaged_->problem;
  if (result.problem.empty()) {
    const std::vector<BoardSample> all = SamplesAsChosen(*samples_, averaged_->chosen);
    const std::vector<const BoardSample*> samples =
        SamplesWithout(all, averaged_->inconsistent_ids);
    const BestExtrinsic best =
        RefineBest(samples,
                   rig_.board,
                   rig_.camera,
                   FromMessage(*averaged_),
                   scene_views_ ? scene_views_(samples) : std::vector<SceneView>(),
                   rig_.extrinsic_refiner);
    result = ToMessage(best, IdsOf(samples));
  }
  StampMadeFrom(*samples_, &result);
  return result;
}

}  // namespace voqcal
