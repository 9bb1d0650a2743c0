#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera_detection/corner_grid.hpp"

namespace voqcal {

/// What is wrong with an image of the board: a miss where no pose could be trusted, else a warning.
enum class CameraBoardFault {
  kNoBoard,       ///< Miss: nothing like the board's pattern.
  kPartlyHidden,  ///< Miss: a part of the pattern.
  kNoPose,        ///< Miss: corners, but no pose in front of the camera explains them.
  kPoorFit,       ///< Miss: reprojection RMS above the option.
  kBlurred,       ///< Miss if edges run into each other; a warning if they are only wide.
  kGlare,         ///< Miss if corners are lost in white; a warning if some are only pale.
  kCutOff,        ///< Miss if corners lie beyond the image's border; a warning if the outline does.
  kTooSmall,      ///< Warning: few pixels to a square.
  kAmbiguous,     ///< Warning: the board tilted the other way would look nearly the same.
};

/// "no board", "partly hidden", ...: as MODULE_STATUS counts them.
std::string ToString(CameraBoardFault fault);

/// Why an image shows no board.
struct CameraBoardMiss {
  CameraBoardFault fault = CameraBoardFault::kNoBoard;
  std::string detail;  ///< What was measured: "edge width 12.1 px of squares of 22.0 px, ...".
  /// Of kNoPose and kPoorFit, which may tell of a wrong lens: the inner corners, in
  /// BoardSpec::InnerCornersBoardM order; NaN: not seen.
  std::vector<Eigen::Vector2d> corners_px = {};
};

/// Why only `part` of a chessboard was found: it goes beyond the image's border, is lost in glare,
/// or is hidden.
/// @param part  in pixels of `grey`.
CameraBoardMiss ExplainPart(const cv::Mat& grey, const BoardSpec& board, const CornerGrid& part);

/// Text of a fault's detail: "edge width 4.1 px, at most 3".
std::string Measured(const char* what, double value, const char* unit_and_rule, double limit);

}  // namespace voqcal
