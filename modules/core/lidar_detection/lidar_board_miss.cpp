#include "core/lidar_detection/lidar_board_miss.hpp"

#include <stdexcept>

namespace voqcal {

std::string ToString(LidarBoardMiss miss) {
  switch (miss) {
    case LidarBoardMiss::kTooFewPoints:
      return "too few points";
    case LidarBoardMiss::kNoPlane:
      return "no plane of the board's size";
    case LidarBoardMiss::kSizeMismatch:
      return "size mismatch";
    case LidarBoardMiss::kFlat:
      return "seen at too flat an angle";
    case LidarBoardMiss::kJoined:
      return "joined to something";
    case LidarBoardMiss::kCutOff:
      return "leaves the field of view";
    case LidarBoardMiss::kGap:
      return "the scan leaves a gap";
    case LidarBoardMiss::kHidden:
      return "something stands before it";
    case LidarBoardMiss::kLoose:
      return "too few beams tell its outline";
    case LidarBoardMiss::kBent:
      return "board bent";
    case LidarBoardMiss::kAmbiguous:
      return "ambiguous";
  }
  throw std::logic_error("ToString: unknown LidarBoardMiss");
}

std::string ToString(const NoLidarBoard& none) {
  if (none.detail.empty()) return ToString(none.miss);
  return ToString(none.miss) + " " + none.detail;
}

}  // namespace voqcal
