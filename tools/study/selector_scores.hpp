#pragma once

#include <string>
#include <vector>

#include "core/assessment/scores.hpp"
#include "core/board/board_sample.hpp"
#include "core/selection/select_sets.hpp"
#include "rig/rig.hpp"
#include "study/all_sets.hpp"

namespace voqcal {

/// How well one criterion's sets calibrate poses that had no part in it.
struct SelectorScore {
  std::string name;
  Spread average_mm;  ///< Centre error of each pose, by the average of sets chosen without it.
  Spread final_mm;    ///< The same, by the extrinsic refined from it (by reprojection).
};

/// Leave-one-out over the samples: for each, sets are chosen among the others, calibrated, averaged
/// and refined, and the sample is scored. kRandom is drawn ten times, all of which count.
/// A sample that some step gives no extrinsic for makes the figures NaN.
SelectorScore CrossValidate(const std::vector<BoardSample>& samples,
                            const Rig& rig,
                            SelectionCriterion criterion);

/// How well a figure that is known before calibration ranks the sets by their held-out error.
struct RankCorrelation {
  std::string figure;
  double spearman = 0.0;  ///< 1: the order is right; 0: chance. The figure's sign is such that
                          ///< lower should be better.
};

std::vector<RankCorrelation> RankCorrelations(const std::vector<StudiedSet>& sets);

}  // namespace voqcal
