#pragma once

#include <string>
#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/predicted_error.hpp"
#include "core/assessment/score_bins.hpp"
#include "core/scene/scene_check.hpp"

namespace voqcal {

// Parts of extrinsic.yaml: each is whole lines, of the indent that its place needs.

/// `name: {mean: .., std: .., max: ..}` of each figure, indented by four.
std::string ScoreYaml(const SceneScore& score);

/// The held-out errors by part of the scene, under `scores`.
std::string BinsYaml(const std::string& name, const std::vector<ScoreBin>& bins);

std::string PredictedYaml(const std::vector<PredictedError>& predicted);
std::string SceneCheckYaml(const SceneCheck& check);
std::string DiagnosisYaml(const Diagnosis& diagnosis);

/// Text as a YAML string on one line.
std::string QuotedYaml(const std::string& text);

}  // namespace voqcal
