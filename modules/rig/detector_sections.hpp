#pragma once

#include "core/camera_detection/camera_board.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "files/option_section.hpp"

namespace voqcal {

void ReadLidarBoardDetector(OptionSection* top, LidarBoardOptions* options);
void ReadCameraBoardDetector(OptionSection* top, CameraBoardOptions* options);

}  // namespace voqcal
