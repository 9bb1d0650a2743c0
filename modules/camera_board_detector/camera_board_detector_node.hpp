#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/image_t.hpp"

namespace voqcal {

/// CAMERA_IMAGE in, CAMERA_BOARD out: one message for every image, with the board or the reason for
/// none.
class CameraBoardDetectorNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  CameraBoardDetectorNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "camera_board_detector"; }
  std::string State() const override;

 private:
  void OnImage(const image_t& message);
  /// Keeps a view whose corners fit no pose, and asks now and then what that tells of the lens.
  void KeepUnposed(const std::vector<Eigen::Vector2d>& corners_px);

  Rig rig_;
  Bus& bus_;
  std::int64_t seq_ = 0;
  std::int64_t num_boards_ = 0;
  std::int64_t num_unposed_ = 0;  // images that show the pattern, in no pose
  std::vector<std::vector<Eigen::Vector2d>> unposed_px_;  // the first of them
  std::string lens_trouble_;
};

}  // namespace voqcal
