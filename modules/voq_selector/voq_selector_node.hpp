#pragma once

#include <optional>
#include <string>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/samples_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES in, VOQ_SETS out: drops the samples that disagree with the others, takes of each
/// sample the lidar's candidate that agrees, and chooses the sets among the rest.
class VoqSelectorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  VoqSelectorNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "voq_selector"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  voq_sets_t Select(const samples_t& message) const;

  Rig rig_;
  Bus& bus_;
  std::optional<samples_t> samples_;
  std::optional<voq_sets_t> result_;
};

}  // namespace voqcal
