#include "camera_board_detector/camera_board_detector_node.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/core/mat.hpp>

#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"

namespace voqcal {
namespace {

// Nothing, and why, for an image that cannot be decoded: one frame's fault, not the module's.
std::optional<cv::Mat> PictureOf(const image_t& message, std::string* miss) try {
  return FromMessage(message);
} catch (const std::runtime_error& error) {
  *miss = error.what();
  return {};
}

}  // namespace

CameraBoardDetectorNode::CameraBoardDetectorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Subscribe<image_t>(rig_.channels.camera_image,
                          Queue::kEvery,
                          [this](const image_t& message) { OnImage(message); });
}

void CameraBoardDetectorNode::OnImage(const image_t& message) {
  std::string miss;
  std::optional<CameraBoard> board;
  if (const auto picture = PictureOf(message, &miss)) {
    // An image of another size is a wrong rig file: it throws, and ends the module.
    auto found = DetectCameraBoard(*picture, rig_.camera, rig_.board, rig_.camera_board_detector);
    if (found) {
      board = std::move(*found);
    } else {
      miss = ToString(found.error());
    }
  }
  Count(miss.empty() ? "boards" : miss);
  bus_.Publish(rig_.channels.camera_board, CameraBoardMessage(board, miss, message.utime, seq_++));
}

}  // namespace voqcal
