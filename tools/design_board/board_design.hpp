#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_spec.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Where a board's result is judged, from the camera.
inline constexpr std::array<double, 3> kDesignRangesM = {5.0, 20.0, 50.0};

/// What a board is predicted to give with so many poses, each held where the guidance asks for it.
struct BoardDesign {
  BoardSpec board;
  int num_poses = 0;
  std::array<double, kDesignRangesM.size()> worst_errors_mm{};  ///< At kDesignRangesM.
};

/// The board, so many times as large: everything on it grows with it, to whole millimetres.
BoardSpec Scaled(const BoardSpec& board, double scale);

/// Predictions after each of `nums_poses` (ascending), as far as there are places for them.
/// By information alone: of errors that the likelihood does not model it knows nothing.
///
/// @param why_fewer  why there were no further places; empty if there were.
std::vector<BoardDesign> PredictDesigns(const Rig& rig,
                                        const BoardSpec& board,
                                        const std::vector<int>& nums_poses,
                                        std::string* why_fewer);

/// The first that keeps the tolerance at the first range: of boards in ascending order the
/// smallest.
std::optional<BoardDesign> Recommended(const std::vector<BoardDesign>& designs,
                                       double tolerance_mm);

}  // namespace voqcal
