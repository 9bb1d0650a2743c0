#include "core/scene/scene_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "core/format.hpp"
#include "core/parallel.hpp"
#include "core/problems.hpp"
#include "core/scene/scene_problem.hpp"
#include "core/scene/scene_solver.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kNumFolds = 6;

SceneVector Solve(const SceneProblem& scene,
                  Sectors sectors,
                  double scale,
                  int max_iterations,
                  SceneVector unknowns) {
  for (const auto& fields : scene.levels) {
    MinimiseAt(scene, fields, sectors, scale, max_iterations, &unknowns);
  }
  return unknowns;
}

// Each fold of the sectors by what the others give.
void CrossValidate(const SceneProblem& scene,
                   double scale,
                   int max_iterations,
                   const SceneVector& unknowns,
                   SceneRefinement* refined) {
  std::array<double, kNumFolds> gains{};
  ParallelFor(kNumFolds, [&](std::size_t fold) {
    const Sectors held_out = (1U << fold) | (1U << (fold + kNumFolds));
    SceneVector others = unknowns;
    MinimiseAt(scene, scene.Finest(), kAllSectors & ~held_out, scale, max_iterations, &others);
    SceneVector before = SceneVector::Zero();
    before[6] = others[6];  // the outset is no merit of the extrinsic
    gains[fold] = MeanSurprise(scene, held_out, before) - MeanSurprise(scene, held_out, others);
  });
  double mean = 0;
  for (const double gain : gains) mean += gain / kNumFolds;
  double variance = 0;
  for (const double gain : gains) variance += (gain - mean) * (gain - mean) / (kNumFolds - 1.0);
  refined->held_out_gain = mean;
  refined->held_out_gain_sigma = std::sqrt(variance / kNumFolds);
}

Matrix6d CovarianceAt(const SceneProblem& scene,
                      const SceneVector& unknowns,
                      double scale,
                      double shared_error_rad) {
  const SceneMatrix information = scene.prior + scale * CurvatureAt(scene, unknowns);
  Matrix6d covariance = information.inverse().topLeftCorner<6, 6>();
  // Not beyond what was known without the scene.
  for (int i = 0; i < 3; ++i) {
    const double before = scene.prior.topLeftCorner<6, 6>().inverse()(i, i);
    covariance(i, i) = std::min(before, covariance(i, i) + shared_error_rad * shared_error_rad);
  }
  return covariance;
}

SceneProblem ProblemOf(const std::vector<SceneView>& views,
                       std::vector<SceneEdge> edges,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar,
                       const Matrix6d& covariance,
                       const SceneRefinementOptions& options) {
  SceneProblem scene;
  scene.edges = std::move(edges);
  scene.camera = camera;
  scene.T_camera_lidar = T_camera_lidar;
  scene.prior.topLeftCorner<6, 6>() = covariance.inverse();
  scene.prior(6, 6) = 1 / (options.outset_prior_rad * options.outset_prior_rad);
  for (const double blur_px : options.blurs_px) {
    scene.levels.push_back(MakeEdgeFields(views, blur_px));
  }
  return scene;
}

// Minimises with the trust that the minimum before shows; ends with the last one's.
SceneVector Estimate(const SceneProblem& scene, int max_iterations, SceneTrust* trust) {
  constexpr int kRounds = 2;
  SceneVector unknowns = SceneVector::Zero();
  *trust = TrustAt(scene, unknowns);
  for (int round = 0; round < kRounds; ++round) {
    unknowns = Solve(scene, kAllSectors, trust->scale, max_iterations, unknowns);
    *trust = TrustAt(scene, unknowns);
  }
  MinimiseAt(scene, scene.Finest(), kAllSectors, trust->scale, max_iterations, &unknowns);
  return unknowns;
}

std::string ReasonOf(const SceneRefinement& refined) {
  constexpr double kUnexpectedChi2 = 12.6;  // one in twenty, of six degrees of freedom
  std::string text = Format("parts of the scene left out fit %s by %.4f +- %.4f",
                            refined.held_out_gain > 0 ? "better" : "worse",
                            std::abs(refined.held_out_gain),
                            refined.held_out_gain_sigma);
  if (!refined.is_used) return "the boards alone decide: " + text;
  text += Format(" when turned by %.3f deg and shifted by %.1f mm from where the boards put it",
                 kDegPerRad * refined.move.head<3>().norm(),
                 1e3 * refined.move.tail<3>().norm());
  if (refined.move_chi2 > kUnexpectedChi2) text += ", which is beyond the boards' own interval";
  return text;
}

}  // namespace

std::vector<std::string> SceneRefinementOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("min_edges", min_edges);
  problems.Require(!blurs_px.empty(), "blurs_px must not be empty", blurs_px.size());
  for (const double blur_px : blurs_px) problems.RequirePositive("blurs_px", blur_px);
  problems.RequirePositive("outset_prior_rad", outset_prior_rad);
  problems.RequirePositive("shared_error_rad", shared_error_rad);
  problems.Require(min_gain_sigmas >= 0, "min_gain_sigmas must not be negative", min_gain_sigmas);
  problems.RequirePositive("max_iterations", max_iterations);
  return problems.lines();
}

SceneRefinement RefineByScene(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar,
                              const Matrix6d& covariance,
                              const SceneRefinementOptions& options) {
  RequireUsable("SceneRefinementOptions", options.Problems());
  SceneRefinement refined;
  refined.T_camera_lidar = T_camera_lidar;
  refined.covariance = covariance;
  std::vector<SceneEdge> edges = SceneEdgesInView(views, camera, T_camera_lidar);
  refined.num_scenes = static_cast<int>(views.size());
  refined.num_edges = static_cast<int>(edges.size());
  if (refined.num_edges < options.min_edges) {
    refined.reason = views.empty()
                         ? "no scene was kept with the samples"
                         : Format("only %d depth edges lie in the images", refined.num_edges);
    return refined;
  }
  const SceneProblem scene =
      ProblemOf(views, std::move(edges), camera, T_camera_lidar, covariance, options);
  SceneTrust trust;
  const SceneVector unknowns = Estimate(scene, options.max_iterations, &trust);
  refined.redundancy = trust.redundancy;
  refined.outset_rad = unknowns[6];
  refined.surprise_before = MeanSurprise(scene, kAllSectors, SceneVector::Zero());
  refined.surprise_after = MeanSurprise(scene, kAllSectors, unknowns);
  refined.move = unknowns.head<6>();
  refined.move_covariance = CovarianceAt(scene, unknowns, trust.scale, options.shared_error_rad);
  refined.move_chi2 = refined.move.dot(scene.prior.topLeftCorner<6, 6>() * refined.move);
  CrossValidate(scene, trust.scale, options.max_iterations, unknowns, &refined);
  refined.is_used = refined.held_out_gain > options.min_gain_sigmas * refined.held_out_gain_sigma;
  refined.reason = ReasonOf(refined);
  if (!refined.is_used) return refined;
  refined.T_camera_lidar = PerturbLeft(T_camera_lidar, refined.move);
  refined.covariance = refined.move_covariance;
  return refined;
}

}  // namespace voqcal
