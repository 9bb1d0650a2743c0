#include "camera_board_detector/camera_board_detector_node.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/core/mat.hpp>

#include "core/assessment/lens_cause.hpp"
#include "core/expected.hpp"
#include "core/format.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_image.hpp"

namespace voqcal {
namespace {

struct Miss {
  std::string reason;  ///< One of a few, to be counted.
  std::string detail;
  std::vector<Eigen::Vector2d> corners_px = {};  ///< Of a pattern that fits no pose.
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
  if (!board) {
    const CameraBoardMiss& miss = board.error();
    return Miss{ToString(miss.fault), miss.detail, miss.corners_px};
  }
  return std::move(*board);
}

}  // namespace

CameraBoardDetectorNode::CameraBoardDetectorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Subscribe<image_t>(rig_.channels.camera_image,
                          Queue::kEvery,
                          [this](const image_t& message) { OnImage(message); });
}

std::string CameraBoardDetectorNode::State() const {
  const bool is_now = !lens_trouble_.empty() && num_unposed_ > num_boards_;
  return is_now ? "trouble: " + lens_trouble_ : Module::State();
}

void CameraBoardDetectorNode::KeepUnposed(const std::vector<Eigen::Vector2d>& corners_px) {
  constexpr std::size_t kFirstAsked = 5;
  constexpr std::size_t kMostKept = 40;
  ++num_unposed_;
  if (unposed_px_.size() == kMostKept) return;
  unposed_px_.push_back(corners_px);
  const std::size_t num = unposed_px_.size();
  const bool is_to_be_asked = num == kFirstAsked || num == 2 * kFirstAsked || num == kMostKept;
  if (!is_to_be_asked || num_unposed_ <= num_boards_) return;
  const auto cause = FindLensCause(
      unposed_px_, rig_.board, rig_.camera, rig_.camera_board_detector.max_reprojection_rms_px);
  lens_trouble_ = cause ? Format("%s; %s (%zu of %zu images of the board fit then)",
                                 cause->claim.c_str(),
                                 cause->remedy.c_str(),
                                 cause->num_fitting,
                                 num)
                        : "";
}

void CameraBoardDetectorNode::OnImage(const image_t& message) {
  const auto board = BoardIn(message, rig_);
  const Miss miss = board ? Miss{} : board.error();
  Count(board ? "boards" : miss.reason);
  if (board) {
    ++num_boards_;
    for (const SightingWarning& warning : board->warnings) Count("boards: " + warning.reason);
  } else if (!miss.corners_px.empty()) {
    KeepUnposed(miss.corners_px);
  }
  bus_.Publish(rig_.channels.camera_board,
               CameraBoardMessage(board ? std::optional(*board) : std::nullopt,
                                  miss.reason,
                                  miss.detail,
                                  message.utime,
                                  seq_++));
}

}  // namespace voqcal
