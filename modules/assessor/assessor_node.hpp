#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/calibration/calibrate.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"
#include "voqcal/assessment_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {

/// CALIB_SAMPLES, EXTRINSIC_AVERAGED and EXTRINSIC_REFINED in, CALIB_ASSESSMENT and extrinsic.yaml
/// out: scores both extrinsics over the whole scene, the refined one also by leave-one-out, checks
/// it on the scenes that samples.lcm keeps, and says what is likely wrong.
class AssessorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  /// @param session_folder  where extrinsic.yaml goes, whole or not at all.
  /// @param scene_views  of the session's samples; empty: by the folder's own samples.lcm.
  AssessorNode(const Rig& rig,
               Bus* bus,
               const std::filesystem::path& session_folder,
               SceneViewsOf scene_views = {});

  std::string Name() const override { return "assessor"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

  /// Whether `result` and `problem` are of these samples.
  bool HasAssessed(const samples_t& samples) const;
  /// The newest result; nothing until there is one, or if the newest samples give none.
  const std::optional<CalibrationResult>& result() const { return result_; }
  /// Why the newest samples give no result; empty if they do, or if there are none yet.
  std::string problem() const { return assessment_ ? assessment_->problem : ""; }

 private:
  void UpdateAssessment();
  CalibrationResult Result();

  Rig rig_;
  Bus& bus_;
  std::filesystem::path session_folder_;
  SceneViewsOf scene_views_;
  std::optional<samples_t> samples_;
  std::optional<extrinsic_averaged_t> averaged_;
  std::optional<extrinsic_refined_t> refined_;
  std::optional<assessment_t> assessment_;
  std::optional<CalibrationResult> result_;
};

}  // namespace voqcal
