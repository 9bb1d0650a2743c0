#pragma once

#include <optional>
#include <string>

#include "core/calibration/calibrate.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES and EXTRINSIC_AVERAGED in, EXTRINSIC_REFINED out: refines the average over every
/// consistent sample and its scene.
class ExtrinsicRefinerNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  /// @param scene_views  of the session's samples; empty: the boards alone.
  ExtrinsicRefinerNode(const Rig& rig, Bus* bus, SceneViewsOf scene_views = {});

  std::string Name() const override { return "extrinsic_refiner"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  extrinsic_refined_t Refine() const;

  Rig rig_;
  Bus& bus_;
  SceneViewsOf scene_views_;
  std::optional<samples_t> samples_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> result_;
};

}  // namespace voqcal
