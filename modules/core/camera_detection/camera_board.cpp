#include "core/camera_detection/camera_board.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "core/camera_detection/calibration_target.hpp"
#include "core/camera_detection/camera_board_view.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

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

// Edges may be that wide, in pixels, before the image counts as blurred.
double MaxEdgeWidthPx(const CameraModel& camera, const CameraBoardOptions& options) {
  // Pixels and lens alone make 1.2 to 1.8 of a monochrome camera, 2.1 to 2.5 of one whose colours
  // are interpolated or whose lens is soft; corners are as exact there.
  constexpr double kSharpPx = 3.0;
  return std::max(kSharpPx, options.max_edge_width_rad * (camera.fx_px + camera.fy_px) / 2);
}

// Why an image that fits the board still gives no pose to trust; nothing if it does.
std::optional<CameraBoardMiss> Untrusted(const PlanarPose& fit,
                                         const CameraBoardView& view,
                                         const std::vector<Eigen::Vector2d>& corners_px,
                                         const CameraBoardOptions& options) {
  const double max_width_px = options.max_edge_width_squares * view.square_px;
  if (view.edge_width_px > max_width_px) {
    return CameraBoardMiss{CameraBoardFault::kBlurred,
                           Measured("edge width",
                                    view.edge_width_px,
                                    " px, at this size of squares at most",
                                    max_width_px)};
  }
  if (fit.reprojection_rms_px > options.max_reprojection_rms_px) {
    return CameraBoardMiss{CameraBoardFault::kPoorFit,
                           Measured("reprojection RMS",
                                    fit.reprojection_rms_px,
                                    " px, at most",
                                    options.max_reprojection_rms_px),
                           corners_px};
  }
  return {};
}

std::vector<SightingWarning> WarningsOf(const PlanarPose& fit,
                                        const CameraBoardView& view,
                                        double max_edge_width_px,
                                        const CameraBoardOptions& options) {
  std::vector<SightingWarning> warnings;
  const auto warn_if = [&](bool is_so, CameraBoardFault fault, const std::string& detail) {
    if (is_so) warnings.push_back({ToString(fault), detail});
  };
  warn_if(view.edge_width_px > max_edge_width_px,
          CameraBoardFault::kBlurred,
          Measured("edge width", view.edge_width_px, " px, at most", max_edge_width_px));
  warn_if(view.least_contrast < options.min_contrast,
          CameraBoardFault::kGlare,
          Measured("a corner's contrast is",
                   view.least_contrast,
                   " of the median, at least",
                   options.min_contrast));
  warn_if(view.outside_share > options.max_outside_share,
          CameraBoardFault::kCutOff,
          Measured("outside the image lie",
                   100 * view.outside_share,
                   " % of the outline, at most",
                   100 * options.max_outside_share));
  warn_if(view.square_px < options.min_square_px,
          CameraBoardFault::kTooSmall,
          Measured("squares of", view.square_px, " px, at least", options.min_square_px));
  warn_if(fit.mirrored_probability > options.max_mirrored_probability,
          CameraBoardFault::kAmbiguous,
          Measured("the mirrored tilt has a probability of",
                   fit.mirrored_probability,
                   ", at most",
                   options.max_mirrored_probability));
  return warnings;
}

}  // namespace

std::vector<std::string> CameraBoardOptions::Problems() const {
  ProblemList problems;
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  const auto is_share = [](double value) { return value >= 0 && value <= 1; };
  problems.Require(is_positive(max_reprojection_rms_px),
                   "max_reprojection_rms_px must be positive and finite",
                   max_reprojection_rms_px);
  problems.Require(is_positive(max_edge_width_rad),
                   "max_edge_width_rad must be positive and finite",
                   max_edge_width_rad);
  problems.Require(is_positive(max_edge_width_squares),
                   "max_edge_width_squares must be positive and finite",
                   max_edge_width_squares);
  problems.Require(min_square_px >= 0, "min_square_px must not be negative", min_square_px);
  problems.Require(is_share(min_contrast), "min_contrast must be 0 to 1", min_contrast);
  problems.Require(
      is_share(max_outside_share), "max_outside_share must be 0 to 1", max_outside_share);
  problems.Require(is_share(max_mirrored_probability),
                   "max_mirrored_probability must be 0 to 1",
                   max_mirrored_probability);
  return problems.lines();
}

Expected<CameraBoard, CameraBoardMiss> DetectCameraBoard(const cv::Mat& image,
                                                         const CameraModel& camera,
                                                         const BoardSpec& board,
                                                         const CameraBoardOptions& options) {
  RequireUsable("DetectCameraBoard: camera", camera.Problems());
  RequireUsable("DetectCameraBoard: board", BoardProblems(board));
  RequireUsable("DetectCameraBoard: options", options.Problems());
  RequireImage(image, camera);

  const cv::Mat grey = Grey(image);
  const auto corners_px = TargetOf(board).find_corners(grey, board);
  if (!corners_px) return corners_px.error();
  const auto fit = FitSeenCorners(camera, board.InnerCornersBoardM(), *corners_px);
  if (!fit) return CameraBoardMiss{CameraBoardFault::kNoPose, "", *corners_px};
  const CameraBoardView view = MeasureView(grey, camera, board, fit->T_camera_board, *corners_px);
  if (const auto miss = Untrusted(*fit, view, *corners_px, options)) return *miss;

  CameraBoard found;
  found.pose = PoseFromTransform(fit->T_camera_board, board);
  found.pose.covariance = fit->covariance;
  found.corners_px = *corners_px;
  found.reprojection_rms_px = fit->reprojection_rms_px;
  found.warnings = WarningsOf(*fit, view, MaxEdgeWidthPx(camera, options), options);
  return found;
}

}  // namespace voqcal
