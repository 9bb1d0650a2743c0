#pragma once

#include <string>
#include <vector>

#include "core/board/board_sample.hpp"

namespace voqcal {

struct ConsistencyOptions {
  double max_distance_m = 0.06;  ///< Distances between two poses' centres agree within this...
  double max_angle_rad = 0.10;   ///< ...and angles between their normals within this.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// A sample that does not fit the others, and why.
struct InconsistentSample {
  int sample = 0;      ///< Index into the samples.
  std::string reason;  ///< "disagrees with 28 of 29 consistent samples; ...", for people.
};

/// Which samples hold together. Distances between the centres of two poses and angles between their
/// normals are the same in both sensors whatever the extrinsic is; a wrong detection breaks them.
/// So does a lidar whose ranges are all off by b: two centres at an angle a apart come out 2 b
/// sin(a / 2) too far from each other. max_distance_m must leave room for that (b = 60 mm and a =
/// 60 degrees take all of the default).
struct Consistency {
  std::vector<int> consistent;  ///< Ascending indices of a largest subset that agrees pairwise.
  std::vector<InconsistentSample> inconsistent;
};

/// The largest subset whose pairs all agree, as far as growing one from each sample finds it; fewer
/// than three samples cannot be judged and are all taken for consistent. The order of samples only
/// breaks ties.
/// @throws std::invalid_argument if `options` has Problems().
Consistency FindConsistent(const std::vector<BoardSample>& samples,
                           const ConsistencyOptions& options);

}  // namespace voqcal
