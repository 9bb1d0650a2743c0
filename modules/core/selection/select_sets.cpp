#include "core/selection/select_sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>

#include "core/estimation/set_extrinsic.hpp"
#include "core/problems.hpp"
#include "core/selection/best_sets.hpp"

namespace voqcal {
namespace {

using Triple = std::array<int, 3>;

struct Named {
  SelectionCriterion criterion;
  const char* name;
};
constexpr Named kNames[] = {{SelectionCriterion::kVoq, "voq"},
                            {SelectionCriterion::kConditionNumber, "condition_number"},
                            {SelectionCriterion::kDeterminant, "determinant"},
                            {SelectionCriterion::kSceneError, "scene_error"},
                            {SelectionCriterion::kRandom, "random"},
                            {SelectionCriterion::kAllPoses, "all_poses"}};

double KappaOf(const std::vector<BoardSample>& samples, const Triple& set) {
  const BoardSample& a = samples[static_cast<std::size_t>(set[0])];
  const BoardSample& b = samples[static_cast<std::size_t>(set[1])];
  const BoardSample& c = samples[static_cast<std::size_t>(set[2])];
  return std::max(
      NormalConditionNumber(a.lidar.pose.normal, b.lidar.pose.normal, c.lidar.pose.normal),
      NormalConditionNumber(a.camera.pose.normal, b.camera.pose.normal, c.camera.pose.normal));
}

double VolumeOf(const std::vector<BoardSample>& samples, const Triple& set) {
  const BoardSample& a = samples[static_cast<std::size_t>(set[0])];
  const BoardSample& b = samples[static_cast<std::size_t>(set[1])];
  const BoardSample& c = samples[static_cast<std::size_t>(set[2])];
  return std::min(
      std::abs(a.lidar.pose.normal.dot(b.lidar.pose.normal.cross(c.lidar.pose.normal))),
      std::abs(a.camera.pose.normal.dot(b.camera.pose.normal.cross(c.camera.pose.normal))));
}

// The triples of lowest score over all combinations.
template <typename ScoreOf>
std::vector<Triple> BestOfAll(const std::vector<int>& poses, int num_sets, const ScoreOf& score) {
  BestSets best(num_sets);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      for (std::size_t k = j + 1; k < poses.size(); ++k) {
        const Triple set = {poses[i], poses[j], poses[k]};
        const double value = score(set);
        if (std::isfinite(value)) best.Offer({set, value});
      }
    }
  }
  std::vector<Triple> sets;
  for (const ScoredTriple& each : std::move(best).Sorted()) sets.push_back(each.poses);
  return sets;
}

std::vector<Triple> BestBySceneError(const std::vector<BoardSample>& samples,
                                     const std::vector<int>& poses,
                                     const CameraModel& camera,
                                     const SelectionOptions& options) {
  if (poses.size() < 3) return {};
  std::vector<const BoardSample*> all;
  for (const int pose : poses) all.push_back(&samples[static_cast<std::size_t>(pose)]);
  const SceneErrorPredictor predictor(samples, camera, AnalyticExtrinsic(all), options.nominal);
  return BestOfAll(poses, options.num_sets, [&predictor](const Triple& set) {
    return predictor.PredictMm(set);
  });
}

// Draws without replacement. The engine's numbers are the same everywhere, unlike the
// distributions of the standard; that 2^32 is no multiple of n favours the first by n / 2^32.
std::vector<Triple> RandomSets(const std::vector<int>& poses, int num_sets, std::uint32_t seed) {
  const std::size_t n = poses.size();
  if (n < 3) return {};
  std::mt19937 random(seed);
  const std::size_t num_combinations = n * (n - 1) * (n - 2) / 6;
  std::set<Triple> drawn;
  while (drawn.size() < std::min(num_combinations, static_cast<std::size_t>(num_sets))) {
    Triple set = {poses[random() % n], poses[random() % n], poses[random() % n]};
    std::sort(set.begin(), set.end());
    if (set[0] != set[1] && set[1] != set[2]) drawn.insert(set);
  }
  return {drawn.begin(), drawn.end()};
}

std::vector<Triple> ChooseTriples(const std::vector<BoardSample>& samples,
                                  const std::vector<int>& poses,
                                  const CameraModel& camera,
                                  const SelectionOptions& options) {
  switch (options.criterion) {
    case SelectionCriterion::kConditionNumber:
      return BestOfAll(
          poses, options.num_sets, [&samples](const Triple& set) { return KappaOf(samples, set); });
    case SelectionCriterion::kDeterminant:
      return BestOfAll(poses, options.num_sets, [&samples](const Triple& set) {
        return -VolumeOf(samples, set);
      });
    case SelectionCriterion::kSceneError:
      return BestBySceneError(samples, poses, camera, options);
    case SelectionCriterion::kRandom:
      return RandomSets(poses, options.num_sets, options.seed);
    case SelectionCriterion::kVoq:
    case SelectionCriterion::kAllPoses:
      break;
  }
  throw std::logic_error("not a criterion that chooses triples this way");
}

}  // namespace

std::string ToString(SelectionCriterion criterion) {
  for (const Named& each : kNames) {
    if (each.criterion == criterion) return each.name;
  }
  throw std::logic_error("unknown SelectionCriterion");
}

std::optional<SelectionCriterion> SelectionCriterionFromString(const std::string& name) {
  for (const Named& each : kNames) {
    if (each.name == name) return each.criterion;
  }
  return {};
}

std::vector<SelectionCriterion> AllSelectionCriteria() {
  std::vector<SelectionCriterion> all;
  for (const Named& each : kNames) all.push_back(each.criterion);
  return all;
}

std::vector<std::string> SelectionOptions::Problems() const {
  ProblemList problems;
  problems.Require(num_sets >= 1, "num_sets must be at least 1", num_sets);
  problems.Require(nominal.rotation_rad > 0, "rotation_rad must be positive", nominal.rotation_rad);
  problems.Require(nominal.along_ray_m > 0, "along_ray_m must be positive", nominal.along_ray_m);
  problems.Require(nominal.across_px > 0, "across_px must be positive", nominal.across_px);
  return problems.lines();
}

std::vector<VoqSet> SelectSets(const std::vector<BoardSample>& samples,
                               const BoardSpec& board,
                               const CameraModel& camera,
                               const SelectionOptions& options) {
  RequireUsable("SelectionOptions", options.Problems());
  if (options.criterion == SelectionCriterion::kVoq) {
    return SelectByVoq(samples, board, options.num_sets);
  }
  std::vector<int> poses(samples.size());
  std::iota(poses.begin(), poses.end(), 0);
  std::vector<VoqSet> sets;
  const auto add = [&](const std::vector<int>& members) {
    VoqSet set = ScoreVoq(samples, members, board);
    if (std::isfinite(set.voq)) sets.push_back(std::move(set));
  };
  if (options.criterion == SelectionCriterion::kAllPoses) {
    if (poses.size() >= 3) add(poses);
    return sets;
  }
  for (const Triple& set : ChooseTriples(samples, poses, camera, options)) {
    add({set.begin(), set.end()});
  }
  return sets;
}

}  // namespace voqcal
