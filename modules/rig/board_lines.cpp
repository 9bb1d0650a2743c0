#include "rig/board_lines.hpp"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "core/camera_detection/calibration_target.hpp"
#include "files/number_text.hpp"

namespace voqcal {
namespace {

std::string ValueText(double value, int) { return NumberText(value); }
std::string ValueText(int value, int times) { return std::to_string(value / times); }
std::string ValueText(const std::string& value, int) { return value; }

std::string LineOf(const TargetKey& key, const BoardSpec& board) {
  const auto line = [&](auto field) {
    return std::string("  ") + key.name + ": " + ValueText(board.*field, key.times);
  };
  return std::visit(line, key.field);
}

bool IsDefault(const TargetKey& key, const BoardSpec& board) {
  return std::visit([&](auto field) { return board.*field == BoardSpec().*field; }, key.field);
}

/// A pattern without use for its optional keys has all of them as by default.
bool HasOptionalKeys(const CalibrationTarget& target, const BoardSpec& board) {
  return std::any_of(target.keys.begin(), target.keys.end(), [&](const TargetKey& key) {
    return !key.is_required && !IsDefault(key, board);
  });
}

}  // namespace

std::vector<std::string> BoardSectionLines(const BoardSpec& board) {
  std::vector<std::string> lines = {
      "board:",
      "  pattern: " + board.pattern,
      "  width_m: " + NumberText(board.width_m),
      "  height_m: " + NumberText(board.height_m),
      "  pattern_offset_x_m: " + NumberText(board.pattern_offset_x_m),
      "  pattern_offset_y_m: " + NumberText(board.pattern_offset_y_m),
  };
  const CalibrationTarget& target = TargetOf(board);
  const bool has_optional = HasOptionalKeys(target, board);
  for (const TargetKey& key : target.keys) {
    if (key.is_required || has_optional) lines.push_back(LineOf(key, board));
  }
  return lines;
}

}  // namespace voqcal
