#pragma once

#include <optional>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/samples_t.hpp"
#include "voqcal/voq_sets_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES and VOQ_SETS in, EXTRINSIC_AVERAGED out: calibrates each set and averages the
/// results as published.
class ExtrinsicEstimatorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  ExtrinsicEstimatorNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "extrinsic_estimator"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  extrinsic_averaged_t Estimate() const;
  AveragedSets Average() const;

  Rig rig_;
  Bus& bus_;
  std::optional<samples_t> samples_;
  std::optional<voq_sets_t> sets_;
  std::optional<extrinsic_averaged_t> result_;
};

}  // namespace voqcal
