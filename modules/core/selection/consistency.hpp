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

/// A sample of which a runner-up fits the others, and its likeliest candidate does not.
struct ChosenCandidate {
  int sample = 0;      ///< Index into the samples.
  int candidate = 0;   ///< Of its runners_up: 1 is the first of them.
  std::string reason;  ///< Why not the likeliest, for people.
};

/// Which samples hold together. Distances between the centres of two poses and angles between their
/// normals are the same in both sensors whatever the extrinsic is; a wrong detection breaks them.
/// So does a lidar whose ranges are all off by b: two centres at an angle a apart come out 2 b
/// sin(a / 2) too far from each other. max_distance_m must leave room for that (b = 60 mm and a =
/// 60 degrees take all of the default).
///
/// Both limits grow by 3 sigma of the poses' covariances: of a board whose sides were not all
/// measured, or of which the camera has few pixels. Of such a lidar's board the distances of the
/// centres from each other's plane are compared too.
struct Consistency {
  std::vector<int> consistent;  ///< Ascending indices of a largest subset that agrees pairwise.
  std::vector<InconsistentSample> inconsistent;
  std::vector<ChosenCandidate> chosen;  ///< Consistent, but not by their likeliest candidate.
};

/// The largest subset whose pairs all agree, with at most one of the lidar's candidates of each
/// sample, as far as peeling finds it: again and again the candidate that agrees with the fewest
/// others goes (of equals a runner-up first, then the later sample), until all that are left agree;
/// then whatever of those that went agrees with all that stayed comes back. (The exact largest
/// clique may take exponential time. A right candidate agrees with nearly all right ones, and a
/// wrong one with few, by chance.) The time is quadratic in the number of candidates.
///
/// Fewer than three samples cannot be judged: all are taken for consistent.
/// @throws std::invalid_argument if `options` has Problems().
Consistency FindConsistent(const std::vector<BoardSample>& samples,
                           const ConsistencyOptions& options);

/// Makes runner-up `candidate` (1 is the first) the sample's lidar board; what was it takes the
/// runner-up's place.
/// @throws std::out_of_range if there is no such runner-up.
void TakeCandidate(int candidate, BoardSample* sample);

/// The consistent samples, each with the candidate that was chosen for it.
std::vector<BoardSample> ConsistentSamples(const std::vector<BoardSample>& samples,
                                           const Consistency& consistency);

}  // namespace voqcal
