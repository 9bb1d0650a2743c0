#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/diagnosis.hpp"
#include "core/assessment/enough.hpp"
#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/calibration/calibration.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/average.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/scene/scene_check.hpp"
#include "core/scene/scene_view.hpp"
#include "core/selection/consistency.hpp"
#include "core/selection/select_sets.hpp"

namespace voqcal {

/// What each step of the method may do.
struct CalibrationOptions {
  ConsistencyOptions consistency;
  SelectionOptions selection;
  SetExtrinsicOptions set_extrinsic;
  AverageOptions average;
  RefinerOptions refinement;
  SceneCheckOptions scene_check;
  DiagnosisOptions diagnosis;
  EnoughOptions enough;
};

/// What the rig has, and how it is calibrated.
struct CalibrationTask {
  BoardSpec board;
  CameraModel camera;
  CalibrationOptions options;
};

/// Which samples count, and which candidate of the lidar in each.
struct ChosenSamples {
  std::vector<BoardSample> samples;  ///< All, each with the candidate that was chosen for it.
  std::vector<RejectedSample> rejected;
  std::vector<ExchangedSample> exchanged;

  /// Those that were not rejected, in order; they point into `samples`.
  std::vector<const BoardSample*> Used() const;
};

/// The sets that the average is made from, or why there are none.
struct ChosenSets {
  std::vector<VoqSet> sets;        ///< By the criterion, best first; indices into the used samples.
  std::vector<VoqSet> lowest_voq;  ///< As published, whatever the criterion: to compare with.
  std::string problem;             ///< A sentence; empty if there are sets.
};

/// What the sets gave.
struct AveragedSets {
  std::vector<SetExtrinsic> extrinsics;  ///< One a set, in their order.
  AveragedExtrinsic average;
  std::string problem;  ///< A sentence; empty if the average is usable.
};

/// The edges of the samples' scenes, of those that have one. A calibration without scenes has an
/// empty function.
using SceneViewsOf =
    std::function<std::vector<SceneView>(const std::vector<const BoardSample*>& samples)>;

/// Step 1: the samples that agree with one another (FindConsistent), and that none of all the
/// others together contradict (FindOutlying).
ChosenSamples ChooseSamples(const std::vector<BoardSample>& samples,
                            const CameraModel& camera,
                            const ConsistencyOptions& options);

/// Step 2: the best sets among them (SelectSets).
ChosenSets ChooseSets(const ChosenSamples& chosen, const CalibrationTask& task);

/// Step 3: each set's extrinsic, and their mean.
AveragedSets AverageSets(const std::vector<const BoardSample*>& used,
                         const std::vector<VoqSet>& sets,
                         const CalibrationTask& task);

/// Step 4 is RefineBest. Step 5: how good it is, and what is likely wrong.
Calibration Assess(const ChosenSamples& chosen,
                   const AveragedExtrinsic& average,
                   const BestExtrinsic& refined,
                   const SceneViewsOf& scene_views,
                   const CalibrationTask& task);

/// A calibration, or why there is none.
struct CalibrationOutcome {
  ChosenSamples chosen;
  ChosenSets sets;
  AveragedSets averaged;
  BestExtrinsic refined;
  Calibration calibration;
  std::string
      problem;  ///< Of the first step that gave nothing, a sentence; empty if all went well.
};

/// The whole method: samples that agree, the best sets, their average, its refinement over
/// every pose, the assessment.
/// @throws std::invalid_argument if an option has Problems().
CalibrationOutcome Calibrate(const std::vector<BoardSample>& samples,
                             const SceneViewsOf& scene_views,
                             const CalibrationTask& task);

}  // namespace voqcal
