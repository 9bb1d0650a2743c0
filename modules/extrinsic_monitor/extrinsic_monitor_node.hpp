#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "messaging/scene_window.hpp"
#include "rig/rig.hpp"
#include "voqcal/extrinsic_check_t.hpp"

namespace voqcal {

/// LIDAR_POINTS and CAMERA_IMAGE in, EXTRINSIC_CHECK out: for each stretch of `window_s`, whether
/// its scenes agree with an extrinsic.
class ExtrinsicMonitorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  /// @param extrinsic  a result's folder, its extrinsic.yaml, or any YAML with T_camera_lidar.
  /// @throws std::runtime_error if there is no extrinsic.
  ExtrinsicMonitorNode(const Rig& rig, Bus* bus, const std::filesystem::path& extrinsic);

  std::string Name() const override { return "extrinsic_monitor"; }
  std::string State() const override;
  bool Step() override;
  void Republish() override;

 private:
  Rig rig_;
  Bus& bus_;
  std::filesystem::path extrinsic_;
  Eigen::Isometry3d T_camera_lidar_;
  SceneWindow window_;
  std::int64_t seq_ = 0;
  std::optional<extrinsic_check_t> newest_;
};

}  // namespace voqcal
