#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/all_sets.hpp"
#include "study/binned.hpp"
#include "study/selector_scores.hpp"

namespace voqcal {

/// One of the paper's experiments: the sets in bins of one figure.
struct Experiment {
  std::string name;
  std::vector<StudyBin> bins;
};

/// Everything that voq_study computes.
struct Study {
  std::vector<std::int64_t> sample_ids;
  std::vector<StudiedSet> sets;
  std::vector<Experiment> experiments;
  std::vector<RankCorrelation> correlations;
  std::vector<SelectorScore> selectors;
};

/// Writes sets.csv, bins.csv, correlations.csv and selectors.csv; their columns are explained in
/// the note beside this file.
/// @throws std::runtime_error naming the file that cannot be written.
void WriteStudy(const Study& study, const std::filesystem::path& folder);

}  // namespace voqcal
