#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/assessment/verdict.hpp"

namespace voqcal {

/// What tells how much a pair of a rig of several sensors needs samples.
struct PairNeed {
  std::string from;
  std::string to;
  int num_samples = 0;
  std::optional<Grade> grade;  ///< Of its verdict; nothing: it has no result yet.
  bool is_enough = false;      ///< The guide says so.
  bool has_place = true;       ///< It knows where to hold the board next.
  bool can_be_sampled = true;  ///< Its sensors and their detectors send, as far as is known.
  /// Expected over the scene where that is worst, in the unit of the rig's tolerance (mm or px),
  /// which is one for all its pairs; NaN or infinite: not known.
  double worst_error = std::numeric_limits<double>::infinity();
};

/// The pair that needs samples most, which is where the operator is sent next:
/// a pair without a result first (of several the one that has most samples already), then those
/// that the guide does not call enough before those that it does; among them the lower verdict,
/// then the larger error.
///
/// Last comes what more samples would not help: one with a result for which the guide knows no
/// place, then a pair without a result whose two sensors the results of others join (the two may
/// have no view in common; what seem to be samples of them are then none), and behind all what
/// cannot be sampled.
///
/// Who carries the board is not sent to and fro after each sample: `before` stays, if it has
/// samples, while no pair is of a worse kind and none of its own kind has more than twice its
/// error.
/// @param before  the answer of the last time; nothing: none was given.
/// @return its index; nothing if there are no pairs.
std::optional<std::size_t> WeakestPair(const std::vector<PairNeed>& pairs,
                                       const std::optional<std::size_t>& before);

}  // namespace voqcal
