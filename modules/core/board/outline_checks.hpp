#pragma once

#include <array>
#include <vector>

#include "core/board/outline_edges.hpp"
#include "core/board/outline_fit.hpp"

namespace voqcal {

/// How well a rectangle explains the beams around it.
struct Agreement {
  double hits_inside = 0.0;   ///< Share of hits among the beams well inside...
  double hits_outside = 0.0;  ///< ...and among those in a border around it.
  double covered = 0.0;       ///< Share of the rectangle's 4 x 4 fields with a hit.

  /// Nearly all hits inside, nearly all misses outside. `slack` above 1 loosens it for a rough fit.
  bool IsBoardLike(double slack = 1.0) const;
};

Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const RectanglePose& pose);

/// Whether beams around a patch's middle, the origin, may show the board at any angle: hits all
/// over a disc well inside it, hardly any beyond its diagonal. Cheap: most patches fail it.
bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model);

/// An edge is seen if beams miss beyond it, or if at least the hits come up to it.
bool IsSeen(const OutlineEdge& edge);

/// The log-likelihood of hits and misses strewn at random: what a rectangle has to beat.
double LogLikelihoodOfChance(const std::vector<OutlineBeam>& beams);

}  // namespace voqcal
