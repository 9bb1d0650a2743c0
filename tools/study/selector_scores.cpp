#include "study/selector_scores.hpp"

#include <cmath>
#include <functional>

#include "core/calibration/calibrate.hpp"
#include "core/estimation/refine.hpp"
#include "study/statistics.hpp"

namespace voqcal {
namespace {

Spread SpreadOf(const std::vector<double>& values) {
  Spread spread;
  spread.mean = Mean(values);
  spread.std = StandardDeviation(values);
  spread.max = Largest(values);
  return spread;
}

}  // namespace

SelectorScore CrossValidate(const std::vector<BoardSample>& samples,
                            const Rig& rig,
                            SelectionCriterion criterion) {
  CalibrationTask task = rig.Task();
  SelectionOptions& selection = task.options.selection;
  selection.criterion = criterion;
  const std::uint32_t num_draws = criterion == SelectionCriterion::kRandom ? 10 : 1;
  std::vector<double> average_mm, final_mm;
  for (std::uint32_t draw = 0; draw < num_draws; ++draw) {
    selection.seed = rig.voq_selector.seed + draw;
    for (std::size_t held_out = 0; held_out < samples.size(); ++held_out) {
      ChosenSamples others{samples, {}, {}};
      others.samples.erase(others.samples.begin() + static_cast<std::ptrdiff_t>(held_out));
      const AveragedExtrinsic average =
          AverageSets(others.Used(), ChooseSets(others, task).sets, task).average;
      const RefinedExtrinsic refined = RefineExtrinsic(
          others.Used(), rig.camera, average.T_camera_lidar, rig.extrinsic_refiner.reprojection);
      const auto error_mm = [&](bool is_usable, const Eigen::Isometry3d& T_camera_lidar) {
        return is_usable ? ScorePose(samples[held_out], rig.camera, T_camera_lidar).centre_mm
                         : std::nan("");
      };
      average_mm.push_back(error_mm(average.IsUsable(), average.T_camera_lidar));
      final_mm.push_back(
          error_mm(average.IsUsable() && refined.IsUsable(), refined.T_camera_lidar));
    }
  }
  return {ToString(criterion), SpreadOf(average_mm), SpreadOf(final_mm)};
}

std::vector<RankCorrelation> RankCorrelations(const std::vector<StudiedSet>& sets) {
  std::vector<double> held_out_mm;
  for (const StudiedSet& set : sets) {
    if (set.IsScored()) held_out_mm.push_back(set.held_out_mm);
  }
  std::vector<RankCorrelation> correlations;
  const auto add = [&](const char* name, const std::function<double(const StudiedSet&)>& figure) {
    std::vector<double> values;
    for (const StudiedSet& set : sets) {
      if (set.IsScored()) values.push_back(figure(set));
    }
    correlations.push_back({name, SpearmanCorrelation(values, held_out_mm)});
  };
  add("voq", [](const StudiedSet& set) { return set.voq; });
  add("condition_number", [](const StudiedSet& set) { return set.kappa; });
  add("board_error", [](const StudiedSet& set) { return set.board_error_mm; });
  add("determinant", [](const StudiedSet& set) { return -set.volume; });
  add("centre_distance", [](const StudiedSet& set) { return -set.centre_distance_m; });
  add("scene_error", [](const StudiedSet& set) { return set.predicted_error_mm; });
  return correlations;
}

}  // namespace voqcal
