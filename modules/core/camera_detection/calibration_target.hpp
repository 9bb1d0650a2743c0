#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/board/printed_pattern.hpp"
#include "core/camera_detection/camera_board_fault.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// A key of a rig file's section `board` that a pattern is described by.
struct TargetKey {
  const char* name;
  std::variant<double BoardSpec::*, int BoardSpec::*, std::string BoardSpec::*> field;
  const char* meaning;
  bool is_required = true;
  int times = 1;  ///< An int of the file counts so many in the field.
};

/// One kind of pattern: all that is particular to it. Its corners are BoardSpec's grid. To add one:
/// a row in a file of its own, its name in calibration_target.cpp, its file in CMakeLists.txt.
struct CalibrationTarget {
  const char* name;             ///< As `board: pattern` says it.
  std::vector<TargetKey> keys;  ///< Beside the board's size and the pattern's offset.

  /// One line for each broken constraint, with its value; empty if the board is usable.
  std::vector<std::string> (*problems)(const BoardSpec& board);

  /// Whether it looks the same after half a turn about its normal.
  bool (*has_half_turn)(const BoardSpec& board);

  /// How far from the side between two neighbouring corners it is of one shade, as share of that
  /// side's length, with an allowance: the reach of measures across edges.
  double (*reach)(const BoardSpec& board);

  /// The corners in an image (8-bit, 1 channel, not empty), to sub-pixel accuracy, in the order of
  /// BoardSpec::InnerCornersBoardM; NaN for those not seen.
  Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> (*find_corners)(const cv::Mat& grey,
                                                                          const BoardSpec& board);

  PrintedPattern (*print)(const BoardSpec& board);
};

const std::vector<const CalibrationTarget*>& CalibrationTargets();

/// "chessboard, charuco, aprilgrid".
std::string CalibrationTargetNames();

/// Null for an unknown name.
const CalibrationTarget* FindCalibrationTarget(const std::string& name);

/// @throws std::invalid_argument if there is no such pattern.
const CalibrationTarget& TargetOf(const BoardSpec& board);

/// What the rig file calls BoardSpec::square_m: "square_m", or "tagSize".
std::string SideKeyOf(const BoardSpec& board);

/// One line for each broken constraint, the pattern's own included.
std::vector<std::string> BoardProblems(const BoardSpec& board);

}  // namespace voqcal
