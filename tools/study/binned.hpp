#pragma once

#include <vector>

#include "study/all_sets.hpp"

namespace voqcal {

/// The sets of one bin of an experiment of the paper (Tsai et al. 2021, section IV): sets in the
/// order of a figure, in bins of equal count.
struct StudyBin {
  int num_sets = 0;
  double figure = 0.0;  ///< Mean over the bin's sets.
  /// How far the calibration results of the bin lie apart: root of the sum of the three axes'
  /// variances.
  double rotation_spread_deg = 0.0;
  double translation_spread_mm = 0.0;
  double error_mm = 0.0;         ///< Mean over the bin's sets of their mean over the scene.
  double median_error_mm = 0.0;  ///< Median over the bin's sets of the same.
  double deviation_mm = 0.0;     ///< Mean over the bin's sets of their deviation over the scene.
};

/// @param figure   of StudiedSet: &StudiedSet::kappa, ...
/// @param max_kappa  sets above it have no part.
/// Sets without a score have no part either.
std::vector<StudyBin> BinSets(const std::vector<StudiedSet>& sets,
                              double StudiedSet::*figure,
                              double max_kappa,
                              int num_bins);

}  // namespace voqcal
