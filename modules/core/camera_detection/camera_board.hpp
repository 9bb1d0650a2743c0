#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera_detection/camera_board_fault.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// How the camera board detector searches one image, and when it warns.
struct CameraBoardOptions {
  double max_reprojection_rms_px = 1.5;  ///< A worse fit is not this board, or not this camera.
  /// Edges between squares that are wider make the image blurred: as an angle of view, so that it
  /// holds for every resolution. Sharp edges of 3 px are always allowed.
  double max_edge_width_rad = 0.003;
  /// Edges wider than this share of a square run into each other: there is no pose to trust.
  double max_edge_width_squares = 0.7;
  double min_square_px = 8.0;      ///< Smaller squares make the board too small.
  double min_contrast = 0.5;       ///< Of the palest corner, as share of the median; less is glare.
  double max_outside_share = 0.0;  ///< Of the outline; more, and the board is cut off.
  double max_mirrored_probability = 0.01;  ///< Of the other tilt; more makes the pose ambiguous.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Finds the board in one image and its pose by all corners seen, with the true lens model.
///
/// Of a chessboard every corner must be seen; of a board with markers a part is enough.
///
/// Of the two half-turns that a chessboard may not tell apart, the one is taken whose board y axis
/// points up in the image (or, if horizontal, whose x axis does), so that a session is consistent.
///
/// @param image  8-bit, 1 or 3 channels (BGR), of the camera's size.
/// @return the board, or why none was found.
/// @throws std::invalid_argument if `image` has another size or type, or the camera, board or
///     options have Problems().
Expected<CameraBoard, CameraBoardMiss> DetectCameraBoard(const cv::Mat& image,
                                                         const CameraModel& camera,
                                                         const BoardSpec& board,
                                                         const CameraBoardOptions& options);

}  // namespace voqcal
