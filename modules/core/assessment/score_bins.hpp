#pragma once

#include <string>
#include <vector>

#include "core/assessment/scores.hpp"

namespace voqcal {

/// The scores of the poses of one part of the scene.
struct ScoreBin {
  std::string name;  ///< "top left", "2 to 3 m".
  SceneScore score;
};

/// By the cell of a 3 x 3 grid over the image in which the board's centre is seen, row by row;
/// cells without a pose are left out.
/// @param score  of `samples`, one pose each, in order.
std::vector<ScoreBin> BinByImageCell(const std::vector<const BoardSample*>& samples,
                                     const SceneScore& score,
                                     const CameraModel& camera);

/// By the distance of the board's centre from the camera: up to 2, 3, 4, 6, 10 m and beyond; ranges
/// without a pose are left out.
std::vector<ScoreBin> BinByRange(const std::vector<const BoardSample*>& samples,
                                 const SceneScore& score);

}  // namespace voqcal
