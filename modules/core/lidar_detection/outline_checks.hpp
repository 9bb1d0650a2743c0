#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/lidar_detection/outline_edges.hpp"
#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// How well a rectangle explains the beams around it.
struct Agreement {
  double hits_inside = 0.0;   ///< Share of hits among the beams well inside...
  double hits_outside = 0.0;  ///< ...and among those in a border around it.
  /// Share of the rectangle's 4 x 4 fields with a hit, or without any beam between two hits...
  double covered = 0.0;
  /// ...and of the half towards each edge, in BoardSpec's order.
  std::array<double, 4> covered_half{};
  /// Share of the fields where beams went past or ended before, and none hit.
  double empty = 0.0;

  /// Nearly all hits inside, nearly all misses outside.
  bool IsBoardLike() const;
};

/// @param blocked_m  Where beams that end before the plane would have met it.
Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const std::vector<Eigen::Vector2d>& blocked_m,
                  const OutlineModel& model,
                  const RectanglePose& pose);

/// Whether beams around a patch's middle, the origin, may show the board at any angle: hits all
/// over a disc well inside it, hardly any beyond its diagonal. Cheap: most patches fail it.
bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model);

/// Whether so many beams miss beyond an edge that it is certain to be there.
bool IsClosed(const OutlineEdge& edge);

/// The edge (in BoardSpec's order) on whose side the board does not show where it ends, or is not
/// seen itself. Where no beam went at all it need not be seen, if hits come up to all four edges
/// and misses close them: some sensors leave gaps in each sweep. An edge that is not closed may
/// still be seen: where beams past it would have come back from nothing (the sky), the hits must
/// come up to it, to within `max_short_m`.
///
/// @param is_covered  Whether the sensor looks past each edge.
/// @param slack       Above 1 it loosens the test for a rough fit.
std::optional<std::size_t> OpenEdge(const std::array<OutlineEdge, 4>& edges,
                                    const std::array<bool, 4>& is_covered,
                                    const Agreement& agreement,
                                    double max_short_m,
                                    double slack = 1.0);

/// How far a length may be off: `open_m`, which spill, thickness and single scan lines leave open,
/// and a number of standard errors, but never more than `largest_m`.
struct LengthTolerance {
  double open_m;
  double num_sigmas;
  double largest_m;
};

/// Whether the edges, measured freely, are as long as they should be: each, and two opposite ones,
/// which tilted lines lengthen and shorten, in the mean.
bool AreLengthsRight(const std::array<double, 4>& measured_m,
                     const std::array<OutlineEdge, 4>& edges,
                     const std::array<double, 4>& true_m,
                     const LengthTolerance& of_one,
                     const LengthTolerance& of_mean);

/// What the beams say that meet the plane just past an edge.
struct PastEdge {
  static constexpr int kNumParts = 8;

  int num_misses = 0;       ///< The board has ended.
  int num_blocked = 0;      ///< Something stands before it: the board may go on behind it.
  int num_parts_shown = 0;  ///< Of the edge's eight: where more beams miss than are blocked...
  int num_parts_hit = 0;    ///< ...and where more hit than miss: the plane goes on.
};

/// Past each edge (in BoardSpec's order), up to `past_m` from it.
std::array<PastEdge, 4> LookPastEdges(const std::vector<OutlineBeam>& beams,
                                      const std::vector<Eigen::Vector2d>& blocked_m,
                                      const OutlineModel& model,
                                      const RectanglePose& pose,
                                      double past_m);

/// Whether something stands before the half of the rectangle towards `edge`, or just past it.
bool IsHidden(const std::vector<Eigen::Vector2d>& blocked_m,
              const OutlineModel& model,
              const RectanglePose& pose,
              std::size_t edge);

/// The log-likelihood of hits and misses strewn at random: what a rectangle has to beat.
double LogLikelihoodOfChance(const std::vector<OutlineBeam>& beams);

}  // namespace voqcal
