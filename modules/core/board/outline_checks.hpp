#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/board/outline_edges.hpp"
#include "core/board/outline_fit.hpp"

namespace voqcal {

/// How well a rectangle explains the beams around it.
struct Agreement {
  double hits_inside = 0.0;   ///< Share of hits among the beams well inside...
  double hits_outside = 0.0;  ///< ...and among those in a border around it.
  double covered = 0.0;       ///< Share of the rectangle's 4 x 4 fields with a hit...
  /// ...and of the half towards each edge, in BoardSpec's order.
  std::array<double, 4> covered_half{};

  /// Nearly all hits inside, nearly all misses outside. `slack` above 1 loosens it for a rough fit.
  bool IsBoardLike(double slack = 1.0) const;
};

Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const OutlineModel& model,
                  const RectanglePose& pose);

/// Whether beams around a patch's middle, the origin, may show the board at any angle: hits all
/// over a disc well inside it, hardly any beyond its diagonal. Cheap: most patches fail it.
bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model);

/// An edge is seen if beams miss beyond it, or if at least the hits come up to it, to within
/// `max_short_m`.
bool IsSeen(const OutlineEdge& edge, double max_short_m);

/// The edge (in BoardSpec's order) on whose side the board does not show where it ends, or is not
/// seen itself. `slack` above 1 loosens it for a rough fit.
std::optional<std::size_t> OpenEdge(const std::array<OutlineEdge, 4>& edges,
                                    const Agreement& agreement,
                                    double max_short_m,
                                    double slack = 1.0);

/// Whether the edges, measured freely, are as long as they should be: to within 30 mm (what spill,
/// thickness and single scan lines leave open) and four standard errors, but never 150 mm.
bool AreLengthsRight(const std::array<double, 4>& measured_m,
                     const std::array<OutlineEdge, 4>& edges,
                     const std::array<double, 4>& true_m);

/// Whether something stands before the half of the rectangle towards `edge`, or just past it.
bool IsHidden(const std::vector<Eigen::Vector2d>& blocked_m,
              const OutlineModel& model,
              const RectanglePose& pose,
              std::size_t edge);

/// The log-likelihood of hits and misses strewn at random: what a rectangle has to beat.
double LogLikelihoodOfChance(const std::vector<OutlineBeam>& beams);

}  // namespace voqcal
