#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// How the camera board detector searches one image.
struct CameraBoardOptions {
  double max_reprojection_rms_px = 1.5;  ///< A worse fit is not this board, or not this camera.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Why an image shows no board.
enum class CameraBoardMiss {
  kNoChessboard,  ///< The chessboard finder found nothing.
  kNoPose,        ///< Corners, but no pose in front of the camera explains them.
  kPoorFit,       ///< Reprojection RMS above the option.
};

std::string ToString(CameraBoardMiss miss);  ///< "no chessboard", ... as MODULE_STATUS counts them.

/// Finds the chessboard in one image and its pose by all corners with the true lens model.
///
/// Of the two half-turns that the pattern cannot tell apart, the one is taken whose board y axis
/// points up in the image (or, if horizontal, whose x axis does), so that a session is consistent.
///
/// @param image  8-bit, 1 or 3 channels (BGR), of the camera's size.
/// @return the board, or why none was found.
/// @throws std::invalid_argument if `image` has another size or type, or the camera, board or
/// options
///     have Problems().
Expected<CameraBoard, CameraBoardMiss> DetectCameraBoard(const cv::Mat& image,
                                                         const CameraModel& camera,
                                                         const BoardSpec& board,
                                                         const CameraBoardOptions& options);

}  // namespace voqcal
