#include "camera_board_detector/camera_board_detector_node.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/core/mat.hpp>

#include "core/expected.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"

namespace voqcal {
namespace {

struct Miss {
  std::string reason;  ///< One of a few, to be counted.
  std::string detail;
};

std::string SizeText(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px);
}

// An image of another size than the camera's is not decoded: every pose would be wrong, and a
// damaged header must not ask for gigabytes.
Expected<cv::Mat, Miss> PictureOf(const image_t& message, const CameraModel& camera) {
  if (message.width != camera.width_px || message.height != camera.height_px) {
    // The sizes are part of the reason: who sees only the counts needs no more to mend it.
    return Miss{"image of " + SizeText(message.width, message.height) + " px, the camera's are " +
                    SizeText(camera.width_px, camera.height_px),
                ""};
  }
  try {
    return FromMessage(message);
  } catch (const std::runtime_error& error) {
    return Miss{"unreadable image", error.what()};
  }
}

Expected<CameraBoard, Miss> BoardIn(const image_t& message, const Rig& rig) {
  const auto picture = PictureOf(message, rig.camera);
  if (!picture) return picture.error();
  auto board = DetectCameraBoard(*picture, rig.camera, rig.board, rig.camera_board_detector);
  if (!board) return Miss{ToString(board.error().fault), board.error().detail};
  return std::move(*board);
}

}  // namespace

CameraBoardDetectorNode::CameraBoardDetectorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Subscribe<image_t>(rig_.channels.camera_image,
                          Queue::kEvery,
                          [this](const image_t& message) { OnImage(message); });
}

void CameraBoardDetectorNode::OnImage(const image_t& message) {
  const auto board = BoardIn(message, rig_);
  const Miss miss = board ? Miss{} : board.error();
  Count(board ? "boards" : miss.reason);
  if (board) {
    for (const SightingWarning& warning : board->warnings) Count("boards: " + warning.reason);
  }
  bus_.Publish(rig_.channels.camera_board,
               CameraBoardMessage(board ? std::optional(*board) : std::nullopt,
                                  miss.reason,
                                  miss.detail,
                                  message.utime,
                                  seq_++));
}

}  // namespace voqcal
