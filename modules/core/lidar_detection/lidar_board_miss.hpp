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
  kJoined,        ///< May be it, but its plane goes on past a side, or the ground begins there.
  kCutOff,        ///< May be it, but past a side there are no beams: the field of view ends.
  kGap,           ///< May be it, but at a side this sweep left too much unseen.
  kHidden,        ///< May be it, but something stands before a side.
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

std::string ToString(const NoLidarBoard& none);  ///< "something stands before it on the left", ...

}  // namespace voqcal
