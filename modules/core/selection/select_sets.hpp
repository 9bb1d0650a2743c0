#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/selection/scene_error.hpp"
#include "core/selection/voq.hpp"

namespace voqcal {

/// Which sets are chosen. All but the last two rank every combination of three poses.
enum class SelectionCriterion {
  kVoq,              ///< Lowest VOQ, as published.
  kConditionNumber,  ///< Lowest max(kappa_lidar, kappa_camera): VOQ without the board's error.
  kDeterminant,      ///< Largest volume that the normals span: min(|det N_lidar|, |det N_camera|).
  kSceneError,       ///< Lowest predicted error over the scene (SceneErrorPredictor).
  kRandom,           ///< Different combinations drawn by the seed, each as likely as any other.
  kAllPoses,         ///< One set of all poses.
};

/// "voq", "condition_number", "determinant", "scene_error", "random", "all_poses".
std::string ToString(SelectionCriterion criterion);
std::optional<SelectionCriterion> SelectionCriterionFromString(const std::string& name);
/// All of them, in the order of the enumeration.
std::vector<SelectionCriterion> AllSelectionCriteria();

struct SelectionOptions {
  SelectionCriterion criterion = SelectionCriterion::kVoq;
  int num_sets = 50;       ///< How many sets are chosen; kAllPoses is one set.
  std::uint32_t seed = 1;  ///< Of kRandom: the same samples and seed give the same sets.
  NominalNoise nominal;    ///< For kSceneError, where the detectors gave no covariance.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The chosen sets, best first (kRandom: in the order of their indices), each with its VOQ.
///
/// Sets whose VOQ is not finite (singular normals, edges that were not measured) are left out
/// whatever the criterion: they leave the rotation open, or their VOQ unknown. Empty for fewer than
/// three samples.
/// @throws std::invalid_argument if `options` has Problems().
std::vector<VoqSet> SelectSets(const std::vector<BoardSample>& samples,
                               const BoardSpec& board,
                               const CameraModel& camera,
                               const SelectionOptions& options);

}  // namespace voqcal
