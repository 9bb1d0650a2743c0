#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/lidar_detection/outline_edges.hpp"
#include "core/lidar_detection/outline_fit.hpp"

namespace voqcal {

/// How well a rectangle explains the beams around it.
struct Agreement {
  double hits_inside = 0.0;   ///< Share of hits among the beams well inside...
  double hits_outside = 0.0;  ///< ...and among those in a border around it.
  /// Share of the rectangle's 4 x 4 fields with a hit, or without any beam between two hits.
  double covered = 0.0;
  /// Share of the fields where beams went past or ended before, and none hit.
  double empty = 0.0;

  /// Nearly all hits inside, nearly all misses outside.
  bool IsBoardLike() const;
};

Agreement Compare(const std::vector<OutlineBeam>& beams,
                  const std::vector<BlockedBeam>& blocked,
                  const OutlineModel& model,
                  const RectanglePose& pose);

/// Whether beams around a patch's middle, the origin, may show the board at any angle: hits all
/// over a disc well inside it, hardly any beyond its diagonal. Cheap: most patches fail it.
bool CouldShowBoard(const std::vector<OutlineBeam>& beams, const OutlineModel& model);

/// How far a length may be off: `open_m`, which spill, thickness and single scan lines leave open,
/// and a number of standard errors, but never more than `largest_m`.
struct LengthTolerance {
  double open_m;
  double num_sigmas;
  double largest_m;
};

/// Whether the edges, measured freely, are as long as they should be: each, and two opposite ones,
/// which tilted lines lengthen and shorten, in the mean. Only those between two sides that
/// `is_told`.
bool AreLengthsRight(const std::array<double, 4>& measured_m,
                     const std::array<OutlineEdge, 4>& edges,
                     const std::array<double, 4>& true_m,
                     const std::array<bool, 4>& is_told,
                     const LengthTolerance& of_one,
                     const LengthTolerance& of_mean);

/// The log-likelihood of hits and misses strewn at random: what a rectangle has to beat.
double LogLikelihoodOfChance(const std::vector<OutlineBeam>& beams);

}  // namespace voqcal
