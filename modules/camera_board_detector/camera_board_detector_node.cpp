#include "camera_board_detector/camera_board_detector_node.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/core/mat.hpp>

#include "core/assessment/lens_cause.hpp"
#include "core/expected.hpp"
#include "core/format.hpp"
#include "core/median.hpp"
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
    return GreyFromMessage(message);
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

// Of the corners that both views show; 0 if there are none.
double MedianDistancePx(const std::vector<Eigen::Vector2d>& a,
                        const std::vector<Eigen::Vector2d>& b) {
  std::vector<double> distances_px;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double distance_px = (a[i] - b[i]).norm();
    if (std::isfinite(distance_px)) distances_px.push_back(distance_px);
  }
  return distances_px.empty() ? 0.0 : Median(distances_px);
}

}  // namespace

CameraBoardDetectorNode::CameraBoardDetectorNode(const Rig& rig, Bus* bus) : rig_(rig), bus_(*bus) {
  bus_.Subscribe<image_t>(rig_.channels.camera_image,
                          Queue::kEvery,
                          [this](const image_t& message) { OnImage(message); });
}

std::string CameraBoardDetectorNode::State() const {
  const bool is_now = !lens_trouble_.empty() && AreMostUnposed();
  return is_now ? "trouble: " + lens_trouble_ : Module::State();
}

bool CameraBoardDetectorNode::AreMostUnposed() const {
  const auto num = std::count(is_unposed_.begin(), is_unposed_.end(), true);
  return 2 * static_cast<std::size_t>(num) > is_unposed_.size();
}

void CameraBoardDetectorNode::KeepUnposed(const std::vector<Eigen::Vector2d>& corners_px) {
  constexpr double kMovedShare = 0.02;  // of the image's width: a board at rest is one view
  constexpr std::size_t kMostKept = 40;
  const double moved_px = kMovedShare * rig_.camera.width_px;
  const bool is_new =
      std::all_of(unposed_px_.begin(), unposed_px_.end(), [&](const auto& other_px) {
        return MedianDistancePx(corners_px, other_px) > moved_px;
      });
  if (is_new) {
    unposed_px_.push_back(corners_px);
    ++num_kept_;
    if (unposed_px_.size() > kMostKept) unposed_px_.pop_front();
  }
  if (num_kept_ < ask_at_ || !AreMostUnposed()) return;
  ask_at_ = 2 * num_kept_;
  const auto cause = FindLensCause({unposed_px_.begin(), unposed_px_.end()},
                                   rig_.board,
                                   rig_.camera,
                                   rig_.camera_board_detector.max_reprojection_rms_px);
  lens_trouble_ = cause ? Format(
                              "The board's images do not fit the rig file's camera: %s; %s "
                              "(%zu of %zu views of the board fit then)",
                              cause->claim.c_str(),
                              cause->remedy.c_str(),
                              cause->num_fitting,
                              unposed_px_.size())
                        : "";
}

void CameraBoardDetectorNode::OnImage(const image_t& message) {
  const auto board = BoardIn(message, rig_);
  const Miss miss = board ? Miss{} : board.error();
  Count(board ? "boards" : miss.reason);
  if (board) {
    for (const SightingWarning& warning : board->warnings) Count("boards: " + warning.reason);
  }
  if (board || !miss.corners_px.empty()) {
    constexpr std::size_t kRecent = 40;
    is_unposed_.push_back(!board);
    if (is_unposed_.size() > kRecent) is_unposed_.pop_front();
  }
  if (!miss.corners_px.empty()) KeepUnposed(miss.corners_px);
  bus_.Publish(rig_.channels.camera_board,
               CameraBoardMessage(board ? std::optional(*board) : std::nullopt,
                                  miss.reason,
                                  miss.detail,
                                  message.utime,
                                  seq_++));
}

}  // namespace voqcal
