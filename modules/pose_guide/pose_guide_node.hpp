#pragma once

#include <optional>
#include <string>

#include "core/guidance/next_pose.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/next_pose_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES and EXTRINSIC_REFINED in, NEXT_POSE out. EXTRINSIC_AVERAGED tells which samples
/// agree, and serves as the extrinsic as long as there is no refined one: in whatever order the
/// three are heard, the pose ends up the same.
class PoseGuideNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  PoseGuideNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "pose_guide"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  // What is known of the extrinsic of the samples as they are.
  enum class Basis { kSamples, kAverage, kRefined };

  std::optional<Basis> BestBasis() const;  // nothing: what is on its way is waited for
  next_pose_t Propose(Basis basis) const;

  Rig rig_;
  Bus& bus_;
  std::optional<samples_t> samples_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> refined_;
  std::optional<next_pose_t> next_;
  std::optional<Basis> basis_;  // of next_
};

}  // namespace voqcal
