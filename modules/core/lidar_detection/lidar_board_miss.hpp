#pragma once

#include <string>
#include <vector>

#include "core/board/board_sample.hpp"

namespace voqcal {

/// Why a sweep shows no board. Later ones came closer to being it.
enum class LidarBoardMiss {
  kTooFewPoints,  ///< The cloud (or the region of interest) is all but empty.
  kNoPlane,       ///< No planar patch of about the board's size.
  kSizeMismatch,  ///< Planar patches, but none whose outline fits the board's size.
  kFlat,          ///< A patch fits, but its plane is seen at too flat an angle.
  kJoined,        ///< A patch fits, but its plane goes on past one side, or the ground begins there.
  kCutOff,        ///< A patch fits, but past one side there are no beams: the field of view ends.
  kGap,           ///< A patch fits, but at one side this sweep left too much unseen.
  kHidden,        ///< A patch fits, but something stands before one side of it.
  kLoose,         ///< A patch fits, but so few beams tell its outline that it could lie elsewhere.
  kBent,          ///< It has the board's outline, but is not flat.
  kAmbiguous,     ///< Two patches fit equally well.
};

std::string ToString(LidarBoardMiss miss);  ///< "too few points", ... as MODULE_STATUS counts them.

/// A miss, and what a person wants to know of it.
struct NoLidarBoard {
  LidarBoardMiss miss = LidarBoardMiss::kNoPlane;
  std::string detail;  ///< "on the left", "by 12 mm"; empty if there is nothing to add.
  /// What may be the board, but may be something else, best first: for a vote of many sweeps.
  std::vector<LidarBoard> unsure{};
};

std::string ToString(const NoLidarBoard& none);  ///< "partly hidden on the left", ...

}  // namespace voqcal
