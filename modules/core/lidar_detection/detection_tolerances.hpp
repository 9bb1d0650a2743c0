#pragma once

#include <cstddef>

#include "core/lidar_detection/outline_checks.hpp"

namespace voqcal {

// What decides whether a patch is the board. "Halls" are those of `voqcal_figures lidar-detection`,
// "field" the recordings of other people.

/// Fewer hits cannot measure a board: of 30 the centre is off by 30 mm and more.
constexpr std::size_t kMinBoardHits = 30;

/// Beams so near a side may be partly of the board: hits end 5 mm past it, at a slant 10 mm, and
/// offsets between scan lines move them by as much again.
constexpr double kSideMarginM = 0.03;
/// Past a bar along a side, where only what it hangs on is left.
constexpr double kWellPastM = 0.08;
/// Just past a side, and as far as scan lines may be apart.
constexpr double kJustPastM = 0.15;
constexpr double kFarPastM = 0.4;
/// Hits of a whole side come so near it, or so many of their spacings.
constexpr double kMaxShortM = 0.05;
constexpr double kMaxShortSpacings = 1.5;

/// Of a beam, in nats. Boards of the field leave 0.03; windows, doors and people 0.3 and more.
constexpr double kMaxUnexplained = 0.25;
/// Of a first, rough fit.
constexpr double kMaxUnexplainedRoughly = 0.5;

/// How far the distance of two measured sides may be off. In halls full of crates and doors looser
/// ones take more of these for the board, and tighter ones lose more boards.
constexpr LengthTolerance kLengthOfOne{0.03, 4.0, 0.15};
constexpr LengthTolerance kLengthOfMean{0.03, 1.5, 0.08};
/// Where three sides were measured: one pair of them, whose lines may tilt a little more. Upright
/// boards of the field that few level scan lines meet are off by up to 40 mm in the mean.
constexpr LengthTolerance kPairOfOne{0.06, 4.0, 0.15};
constexpr LengthTolerance kPairOfMean{0.03, 1.5, 0.05};
/// The same where the lidar alone may be sure.
constexpr LengthTolerance kSurePairOfMean{0.02, 1.0, 0.05};
/// Where the board is expected, only another thing is refused: stated sizes of plates in the field
/// are off by up to 50 mm.
constexpr LengthTolerance kExpectedOfOne{0.15, 0.0, 0.15};
constexpr LengthTolerance kExpectedOfMean{0.08, 0.0, 0.08};
constexpr double kMaxUnexplainedIfExpected = 0.4;

/// Two sides farther apart by this than the other two suggest are not both the board's: in halls a
/// bar of 50 mm along a side lengthens by 25 to 50 mm.
constexpr double kLengthenedM = 0.02;

/// Share of the 4 x 4 fields with hits: of a board that is measured on three sides, whose fourth
/// may be hidden; and of one where less is measured.
constexpr double kMinCoveredOfThree = 0.6;
/// Hits that three sides need: in the halls, with fewer, other things are taken for the board.
constexpr std::size_t kMinHitsOfThree = 150;
constexpr double kMinCovered = 0.8;

}  // namespace voqcal
