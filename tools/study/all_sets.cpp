#include "study/all_sets.hpp"

#include <algorithm>
#include <cmath>

#include "core/board/metres_per_pixel.hpp"
#include "core/selection/scene_error.hpp"
#include "core/selection/voq.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

using Three = std::array<const BoardSample*, 3>;

double Volume(const Three& set) {
  const auto& [a, b, c] = set;
  return std::min(
      std::abs(a->lidar.pose.normal.dot(b->lidar.pose.normal.cross(c->lidar.pose.normal))),
      std::abs(a->camera.pose.normal.dot(b->camera.pose.normal.cross(c->camera.pose.normal))));
}

double Kappa(const Three& set) {
  const auto& [a, b, c] = set;
  return std::max(
      NormalConditionNumber(a->lidar.pose.normal, b->lidar.pose.normal, c->lidar.pose.normal),
      NormalConditionNumber(a->camera.pose.normal, b->camera.pose.normal, c->camera.pose.normal));
}

double RmsDistanceFromMean(const Three& set) {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  for (const BoardSample* sample : set) mean_m += sample->lidar.pose.centre_m / 3.0;
  double sum_m2 = 0.0;
  for (const BoardSample* sample : set)
    sum_m2 += (sample->lidar.pose.centre_m - mean_m).squaredNorm();
  return std::sqrt(sum_m2 / 3.0);
}

// Fills in how well the set's extrinsic fits the scene.
void Score(const SceneCentres& scene, StudiedSet* set) {
  if (!set->extrinsic.IsUsable()) return;
  double sum_px = 0, sum_mm = 0, sum_mm2 = 0, sum_own_mm = 0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const double px = scene.ErrorPx(i, set->extrinsic.T_camera_lidar);
    const double mm = scene.MillimetresPerPixel(i) * px;
    sum_px += px;
    sum_mm += mm;
    sum_mm2 += mm * mm;
    const bool is_own = std::find(set->samples.begin(), set->samples.end(), static_cast<int>(i)) !=
                        set->samples.end();
    if (is_own) sum_own_mm += mm;
  }
  const double n = static_cast<double>(scene.size());
  set->mean_px = sum_px / n;
  set->mean_mm = sum_mm / n;
  set->deviation_mm = std::sqrt(std::max(0.0, sum_mm2 / n - set->mean_mm * set->mean_mm));
  if (n > 3) set->held_out_mm = (sum_mm - sum_own_mm) / (n - 3);
}

}  // namespace

SceneCentres::SceneCentres(const std::vector<BoardSample>& samples, const CameraModel& camera)
    : camera_(camera) {
  for (const BoardSample& sample : samples) {
    const BoardPose& seen = sample.camera.pose;
    centres_.push_back({sample.lidar.pose.centre_m,
                        camera.Project(seen.centre_m),
                        kMmPerM * MetresPerPixel(seen, camera)});
  }
}

double SceneCentres::ErrorPx(std::size_t sample, const Eigen::Isometry3d& T_camera_lidar) const {
  const Eigen::Vector3d centre_camera_m = T_camera_lidar * centres_[sample].lidar_m;
  if (!camera_.IsInFront(centre_camera_m)) return std::numeric_limits<double>::quiet_NaN();
  return (camera_.Project(centre_camera_m) - centres_[sample].px).norm();
}

std::vector<StudiedSet> StudyAllSets(const std::vector<BoardSample>& samples,
                                     const BoardSpec& board,
                                     const CameraModel& camera,
                                     const SetExtrinsicOptions& options) {
  const SceneCentres scene(samples, camera);
  const SceneErrorPredictor predictor(
      samples,
      camera,
      AnalyticExtrinsic(SamplesWithout(samples, {})),
      {options.sigma_normal_rad, options.sigma_centre_m, options.sigma_centre_px});
  std::vector<double> dimension_errors_mm;
  for (const BoardSample& sample : samples) {
    dimension_errors_mm.push_back(BoardDimensionErrorMm(sample.lidar.edge_lengths_m, board));
  }
  std::vector<StudiedSet> sets;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      for (std::size_t k = j + 1; k < samples.size(); ++k) {
        const Three members = {&samples[i], &samples[j], &samples[k]};
        StudiedSet set;
        set.samples = {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)};
        set.kappa = Kappa(members);
        set.board_error_mm =
            (dimension_errors_mm[i] + dimension_errors_mm[j] + dimension_errors_mm[k]) / 3.0;
        set.voq = set.kappa + set.board_error_mm;
        if (!std::isfinite(set.voq)) continue;
        set.volume = Volume(members);
        set.predicted_error_mm = predictor.PredictMm(set.samples);
        set.centre_distance_m = RmsDistanceFromMean(members);
        set.extrinsic = EstimateSetExtrinsic({members.begin(), members.end()}, camera, options);
        Score(scene, &set);
        sets.push_back(set);
      }
    }
  }
  return sets;
}

}  // namespace voqcal
