#pragma once

#include <filesystem>
#include <vector>

#include "assessor/assessor_node.hpp"
#include "extrinsic_estimator/extrinsic_estimator_node.hpp"
#include "extrinsic_refiner/extrinsic_refiner_node.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "messaging/session_views.hpp"
#include "result/join_rig.hpp"
#include "rig/rig.hpp"
#include "voq_selector/voq_selector_node.hpp"

namespace voqcal {

/// What its session is of; nothing came of it yet.
PairSession SessionOf(const Rig& rig);

/// What makes a pair's result of its samples: the modules of a live pair, one after the other on
/// one bus. The same samples give the bytes that these give as processes.
class PairChain {
 public:
  /// @param bus  hears CALIB_SAMPLES; borrowed.
  /// @param session_folder  has samples.lcm, and gets extrinsic.yaml.
  /// @param on_image  of each sample's scene, as it is decoded.
  PairChain(const Rig& rig,
            Bus* bus,
            const std::filesystem::path& session_folder,
            OnSceneImage on_image = {});

  /// Works on the newest samples that were handled or wait on the bus, until nothing is left to do.
  void Run();

  const AssessorNode& assessor() const { return assessor_; }
  std::vector<const Module*> modules() const;

 private:
  Bus& bus_;
  VoqSelectorNode selector_;
  ExtrinsicEstimatorNode estimator_;
  SceneViewsOf scene_views_;
  ExtrinsicRefinerNode refiner_;
  AssessorNode assessor_;
};

}  // namespace voqcal
