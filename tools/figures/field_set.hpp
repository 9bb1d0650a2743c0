#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/estimation/sighting_errors.hpp"
#include "core/selection/differences_from_others.hpp"

namespace voqcal {

/// What became of one recording of other people.
struct FieldSet {
  std::string name;
  std::size_t num_pairs = 0;
  std::size_t num_camera_boards = 0;
  std::size_t num_lidar_boards = 0;  ///< By the lidar alone.
  std::size_t num_samples = 0;
  std::size_t num_consistent = 0;
  std::vector<SampleDifference> differences;  ///< Of the consistent ones.
  SightingErrors errors;                      ///< Of theirs, beyond their covariances.
  double held_out_mm = 0.0;                   ///< Centre, mean; NaN if unknown.
  std::string problem;                        ///< Why there is no result; empty if there is one.
  std::string counts;                         ///< What each module counted.

  std::size_t NumWrong() const;
};

/// @param folder  has rig.yaml, images/poseN.png and pcd/poseN_full.pcd.
/// @throws std::runtime_error naming the file and the cause.
FieldSet MeasureFieldSet(const std::filesystem::path& folder);

}  // namespace voqcal
