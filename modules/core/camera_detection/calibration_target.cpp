#include "core/camera_detection/calibration_target.hpp"

#include <stdexcept>
#include <variant>

#include "core/camera_detection/aprilgrid_target.hpp"
#include "core/camera_detection/charuco_target.hpp"
#include "core/camera_detection/chessboard_target.hpp"

namespace voqcal {

const std::vector<const CalibrationTarget*>& CalibrationTargets() {
  static const std::vector<const CalibrationTarget*> kTargets = {
      &Chessboard(), &Charuco(), &AprilGrid()};
  return kTargets;
}

std::string CalibrationTargetNames() {
  std::string names;
  for (const CalibrationTarget* target : CalibrationTargets()) {
    names += (names.empty() ? "" : ", ") + std::string(target->name);
  }
  return names;
}

const CalibrationTarget* FindCalibrationTarget(const std::string& name) {
  for (const CalibrationTarget* target : CalibrationTargets()) {
    if (target->name == name) return target;
  }
  return nullptr;
}

const CalibrationTarget& TargetOf(const BoardSpec& board) {
  const CalibrationTarget* target = FindCalibrationTarget(board.pattern);
  if (target != nullptr) return *target;
  throw std::invalid_argument("pattern must be one of " + CalibrationTargetNames() + ", is " +
                              board.pattern);
}

std::string SideKeyOf(const BoardSpec& board) {
  for (const TargetKey& key : TargetOf(board).keys) {
    const auto* field = std::get_if<double BoardSpec::*>(&key.field);
    if (field != nullptr && *field == &BoardSpec::square_m) return key.name;
  }
  throw std::logic_error("no key for the side of what is printed: " + board.pattern);
}

std::vector<std::string> BoardProblems(const BoardSpec& board) {
  const CalibrationTarget* target = FindCalibrationTarget(board.pattern);
  if (target != nullptr) return target->problems(board);
  return {"pattern must be one of " + CalibrationTargetNames() + ", is " + board.pattern};
}

}  // namespace voqcal
