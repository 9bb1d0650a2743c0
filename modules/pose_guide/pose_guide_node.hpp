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
/// agree, and serves as the extrinsic where there is no refined one.
class PoseGuideNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  PoseGuideNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "pose_guide"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  bool HasExtrinsics() const;
  next_pose_t Propose() const;

  Rig rig_;
  Bus& bus_;
  std::optional<samples_t> samples_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> refined_;
  std::optional<next_pose_t> next_;
};

}  // namespace voqcal
