#pragma once

#include <cstdint>
#include <string>

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

 private:
  void OnImage(const image_t& message);

  Rig rig_;
  Bus& bus_;
  std::int64_t seq_ = 0;
};

}  // namespace voqcal
