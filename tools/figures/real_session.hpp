#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "calibrate/collect.hpp"
#include "core/assessment/best_extrinsic.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/scene/scene_view.hpp"
#include "figures/scene_judge.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// One pose of a recording, with its scene as the estimator and as the judge see it.
struct SessionPose {
  BoardSample sample;
  std::optional<SceneView> view;
  std::optional<JudgedScene> judged;
};

/// The poses of a recording that agree with one another.
/// @throws std::runtime_error naming the file and the cause.
std::vector<SessionPose> LoadSession(const Rig& rig, const InputPaths& input);

using SessionPoses = std::vector<const SessionPose*>;

/// The poses in an order of chance; the same seed and number give the same.
SessionPoses Shuffled(const std::vector<SessionPose>& poses, std::uint32_t seed, int number);

std::vector<BoardSample> SamplesOf(const SessionPoses& poses);
std::vector<JudgedScene> JudgedScenesOf(const SessionPoses& poses);
/// Of any of these poses' samples.
SceneViewsOf ViewsOf(const SessionPoses& poses);

/// The whole method on these poses, which are known to agree.
CalibrationOutcome CalibratePoses(const SessionPoses& poses, const CalibrationTask& task);

}  // namespace voqcal
