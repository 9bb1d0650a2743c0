#pragma once

#include <string>
#include <vector>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "rig/rig.hpp"

namespace voqcal {

// What a rig file says that could be true, but hardly is: one line each, with key, value, likely
// cause and remedy ("board.width_m is 767: ... in millimetres?").

std::vector<std::string> BoardDoubts(const BoardSpec& board);
std::vector<std::string> CameraDoubts(const CameraModel& camera);

/// Folders and files of the drivers that are not there, or whose frames would hardly pair. A rig
/// file may serve where they are not: recordings are calibrated without drivers.
std::vector<std::string> DriverDoubts(const Rig& rig);

/// All of them.
std::vector<std::string> RigDoubts(const Rig& rig);

}  // namespace voqcal
