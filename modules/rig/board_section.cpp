#include "rig/board_section.hpp"

#include <variant>

#include "core/camera_detection/calibration_target.hpp"

namespace voqcal {
namespace {

constexpr char kOffsetMeaning[] =
    "where the middle of the inner corners lies, from the middle of the plate. Hold the plate "
    "upright before you, printed face towards you, height_m upwards:\n"
    "      width_m                    chessboard right of the plate's middle: "
    "pattern_offset_x_m > 0\n"
    "  +-----------------+            ... left of it: pattern_offset_x_m < 0\n"
    "  |         +-----+ |            ... above it:   pattern_offset_y_m > 0\n"
    "  |    +    |chess| | height_m   ... below it:   pattern_offset_y_m < 0\n"
    "  |         +-----+ |            As drawn: pattern_offset_x_m > 0, pattern_offset_y_m: 0.\n"
    "  +-----------------+\n"
    "Which way up is upright? num_corners_x + num_corners_y odd: the one with a dark square at the "
    "lower left of the chessboard, whichever way the board is held later. Even: both ways look "
    "alike; hold the board this way up in every pose. calibrate says so if a sign must be the "
    "other one.";

/// "tagCols (tags along the width), ...".
std::string KeysOf(const std::string& pattern) {
  std::string text;
  for (const TargetKey& key : FindCalibrationTarget(pattern)->keys) {
    text += (text.empty() ? "" : ", ") + std::string(key.name) + " (" + key.meaning + ")";
  }
  return text;
}

void ReadTargetKey(const TargetKey& key, OptionSection* section, BoardSpec* board) {
  const auto read = [&](auto field) {
    if (key.is_required) return section->ReadRequired(key.name, &(board->*field), key.meaning);
    section->Read(key.name, &(board->*field), key.meaning);
  };
  std::visit(read, key.field);
  if (const auto* count = std::get_if<int BoardSpec::*>(&key.field)) board->*(*count) *= key.times;
}

/// @return whether it is there, or must be.
bool ReadPlate(OptionSection* section, PlateInRig plate, BoardSpec* board) {
  const bool is_given = section->Has("width_m") || section->Has("height_m");
  if (!is_given && plate == PlateInRig::kMayBeMissing) return false;
  section->ReadRequired("width_m",
                        &board->width_m,
                        "the whole plate's edge along x, not the pattern's. Where width_m and "
                        "height_m are both left out, calibrate measures them in the recording; "
                        "live programs need them");
  section->ReadRequired("height_m", &board->height_m, "its other edge, along y");
  return true;
}

}  // namespace

bool ReadBoard(OptionSection* top, PlateInRig plate, BoardSpec* board) {
  OptionSection section =
      top->RequiredSection("board", "metres; x runs along the width, y along the height");
  if (!top->Has("board")) return true;
  const bool is_plate_given = ReadPlate(&section, plate, board);
  section.Read("pattern_offset_x_m", &board->pattern_offset_x_m, kOffsetMeaning);
  section.Read("pattern_offset_y_m", &board->pattern_offset_y_m, "the same upwards: see above");
  const char* pattern =
      section.Has("target_type") ? "target_type" : "pattern";  // Kalibr's and ours
  section.Read(pattern,
               &board->pattern,
               "what is printed on it: " + CalibrationTargetNames() +
                   " (as OpenCV 4.6 prints it, y up). An AprilGrid has, instead of the keys "
                   "below, those of Kalibr's own file: " +
                   KeysOf("aprilgrid"));
  const CalibrationTarget* target = FindCalibrationTarget(board->pattern);
  if (target == nullptr) {
    section.AddError(pattern, "must be one of " + CalibrationTargetNames());
    return is_plate_given;
  }
  for (const TargetKey& key : target->keys) ReadTargetKey(key, &section, board);
  if (!is_plate_given) {
    board->width_m = board->LeastPlateM().x();
    board->height_m = board->LeastPlateM().y();
  }
  if (section.IsComplete()) section.AddProblems(BoardProblems(*board));
  section.RefuseUnknownKeys();
  return is_plate_given;
}

}  // namespace voqcal
