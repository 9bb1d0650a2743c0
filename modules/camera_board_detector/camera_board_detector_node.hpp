#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
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
  /// Keeps a view whose corners fit no pose, if it is another than those kept, and asks now and
  /// then what they tell of the lens.
  void KeepUnposed(const std::vector<Eigen::Vector2d>& corners_px);
  bool AreMostUnposed() const;

  Rig rig_;
  Bus& bus_;
  std::int64_t seq_ = 0;
  std::deque<bool> is_unposed_;                          // of the last images that show the pattern
  std::deque<std::vector<Eigen::Vector2d>> unposed_px_;  // views that differ, the newest last
  std::size_t num_kept_ = 0;                             // of them, ever
  std::size_t ask_at_ = 5;                               // of num_kept_
  std::string lens_trouble_;
};

}  // namespace voqcal
