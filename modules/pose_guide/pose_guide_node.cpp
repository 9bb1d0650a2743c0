#include "pose_guide/pose_guide_node.hpp"

#include <vector>

#include "core/least_samples.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_guidance.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"

namespace voqcal {

PoseGuideNode::PoseGuideNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Keep(rig_.channels.calib_samples, &samples_);
  bus_.Keep(rig_.channels.extrinsic_averaged, &averaged_);
  bus_.Keep(rig_.channels.extrinsic_refined, &refined_);
}

std::string PoseGuideNode::State() const {
  if (!next_) return "waiting for samples and extrinsics";
  return next_->problem.empty() ? "running" : "waiting: " + next_->problem;
}

bool PoseGuideNode::Step() {
  if (!samples_) return false;
  const std::optional<Basis> basis = BestBasis();
  if (!basis || (next_ && IsMadeFrom(*samples_, *next_) && basis_ == basis)) return false;
  if (!CanRead([&] { next_ = Propose(*basis); })) {
    samples_.reset();
    return false;
  }
  basis_ = basis;
  Count(next_->problem.empty() ? "proposals" : "without a pose");
  Republish();
  return false;
}

void PoseGuideNode::Republish() {
  if (next_) bus_.Publish(rig_.channels.next_pose, *next_);
}

std::optional<PoseGuideNode::Basis> PoseGuideNode::BestBasis() const {
  if (samples_->num_samples < kLeastSamples) return Basis::kSamples;
  if (!averaged_ || !IsMadeFrom(*samples_, *averaged_)) return std::nullopt;
  // Without a refiner the average is all there will be; one that was heard before will be again.
  if (!refined_) return Basis::kAverage;
  if (!IsMadeFrom(*samples_, *refined_)) return std::nullopt;
  return Basis::kRefined;
}

next_pose_t PoseGuideNode::Propose(Basis basis) const {
  std::vector<BoardSample> all = FromMessage(*samples_);
  GuidanceState state;
  if (basis == Basis::kSamples) {
    state.samples = SamplesWithout(all, {});
  } else {
    TakeChosen(averaged_->chosen, &all);
    state.samples = SamplesWithout(all, averaged_->inconsistent_ids);
    if (basis == Basis::kRefined && refined_->problem.empty()) {
      const BestExtrinsic best = FromMessage(*refined_);
      state.belief = {best.T_camera_lidar, best.Bias(), best.likelihood.noise};
      // Of few samples the residuals may tell none.
      if (best.covariance_given_rig.allFinite()) state.covariance = best.covariance_given_rig;
    } else if (averaged_->problem.empty()) {
      state.belief = {FromMessage(averaged_->T_camera_lidar), {}, {}};
    }
  }
  const NextPose next = ProposeNextPose(
      state, {rig_.board, rig_.camera, rig_.extrinsic_refiner.likelihood}, rig_.pose_guide);
  next_pose_t message = ToMessage(next, rig_.pose_guide, rig_.board, rig_.camera);
  StampMadeFrom(*samples_, &message);
  return message;
}

}  // namespace voqcal
