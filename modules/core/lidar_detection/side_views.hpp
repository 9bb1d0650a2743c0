#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// What the beams say of one side of a rectangle.
struct SideEvidence {
  static constexpr std::size_t kNumParts = 8;
  /// What is just past one of eight parts of the side.
  enum class Past : std::uint8_t {
    kUnseen,   ///< No beam.
    kNothing,  ///< Beams go on behind the plane: the board has ended.
    kPlane,    ///< Hits: something joins the board in its plane.
    kTouch,    ///< Returns that come up to the plane: the ground, a sofa.
    kBefore,   ///< Returns well before the plane: what is there cannot be seen.
  };

  SideView view = SideView::kGap;
  std::array<Past, kNumParts> past{};
  int num_joined = 0;    ///< Hits well past it: of a post, a leaf, a hand.
  double reach_m = 0.0;  ///< How far beyond the side the outermost hits lie (< 0: short).

  int Count(Past what) const;
};

/// Of each side, in BoardSpec's order.
///
/// @param spacing_m  of the hits from each other, in the mean.
std::array<SideEvidence, 4> LookAtSides(const std::vector<OutlineBeam>& beams,
                                        const std::vector<BlockedBeam>& blocked,
                                        const OutlineModel& model,
                                        const RectanglePose& pose,
                                        double spacing_m);

/// The beams that tell of the rectangle: all but those past a part of a side where its plane goes
/// on or something comes up to it, which say nothing of where it ends.
std::vector<OutlineBeam> TellingBeams(const std::vector<OutlineBeam>& beams,
                                      const OutlineModel& model,
                                      const RectanglePose& pose,
                                      const std::array<SideEvidence, 4>& sides);

int NumMeasured(const std::array<SideEvidence, 4>& sides);

}  // namespace voqcal
