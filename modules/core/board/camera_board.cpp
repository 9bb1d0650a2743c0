#include "core/board/camera_board.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "core/board/chessboard_corners.hpp"
#include "core/board/planar_pose.hpp"

namespace voqcal {
namespace {

void RequireUsable(const char* what, const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text = std::string("DetectCameraBoard: ") + what;
  for (std::size_t i = 0; i < problems.size(); ++i) text += (i == 0 ? ": " : "; ") + problems[i];
  throw std::invalid_argument(text);
}

void RequireImage(const cv::Mat& image, const CameraModel& camera) {
  std::ostringstream text;
  text << "DetectCameraBoard: ";
  if (image.cols != camera.width_px || image.rows != camera.height_px) {
    text << "the image is " << image.cols << " x " << image.rows << " pixels, the camera's are "
         << camera.width_px << " x " << camera.height_px;
    throw std::invalid_argument(text.str());
  }
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    text << "the image must have 8 bits and 1 or 3 channels, has " << 8 * image.elemSize1()
         << " bits and " << image.channels() << " channels (OpenCV type " << image.type() << ")";
    throw std::invalid_argument(text.str());
  }
}

cv::Mat Grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace

std::vector<std::string> CameraBoardOptions::Problems() const {
  if (max_reprojection_rms_px > 0 && std::isfinite(max_reprojection_rms_px)) return {};
  std::ostringstream text;
  text << "max_reprojection_rms_px must be positive and finite, is " << max_reprojection_rms_px;
  return {text.str()};
}

std::string ToString(CameraBoardMiss miss) {
  switch (miss) {
    case CameraBoardMiss::kNoChessboard:
      return "no chessboard";
    case CameraBoardMiss::kNoPose:
      return "no pose";
    case CameraBoardMiss::kPoorFit:
      return "poor fit";
  }
  return "unknown";
}

Expected<CameraBoard, CameraBoardMiss> DetectCameraBoard(const cv::Mat& image,
                                                         const CameraModel& camera,
                                                         const BoardSpec& board,
                                                         const CameraBoardOptions& options) {
  RequireUsable("camera", camera.Problems());
  RequireUsable("board", board.Problems());
  RequireUsable("options", options.Problems());
  RequireImage(image, camera);

  const auto corners_px = FindChessboardCorners(Grey(image), board);
  if (!corners_px) return CameraBoardMiss::kNoChessboard;
  const auto fit = FitPlanarPose(camera, board.InnerCornersBoardM(), *corners_px);
  if (!fit) return CameraBoardMiss::kNoPose;
  if (fit->reprojection_rms_px > options.max_reprojection_rms_px) return CameraBoardMiss::kPoorFit;

  CameraBoard found;
  found.pose = PoseFromTransform(fit->T_camera_board, board);
  found.pose.covariance = fit->covariance;
  found.corners_px = *corners_px;
  found.reprojection_rms_px = fit->reprojection_rms_px;
  return found;
}

}  // namespace voqcal
