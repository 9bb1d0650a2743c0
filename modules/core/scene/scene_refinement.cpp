#include "core/scene/scene_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/format.hpp"
#include "core/problems.hpp"
#include "core/scene/scene_fit.hpp"
#include "core/scene/scene_problem.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

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
    refined.reason = TooFewEdges(refined.num_scenes, refined.num_edges);
    return refined;
  }
  const SceneFit fit =
      FitScene(views, std::move(edges), camera, T_camera_lidar, covariance, options);
  const auto& [scene, trust, unknowns] = fit;
  refined.redundancy = trust.redundancy;
  refined.outset_rad = unknowns[6];
  refined.surprise_before = MeanSurprise(scene, kAllSectors, SceneVector::Zero());
  refined.surprise_after = MeanSurprise(scene, kAllSectors, unknowns);
  refined.move = unknowns.head<6>();
  refined.move_covariance = CovarianceOf(fit, options.shared_error_rad);
  refined.move_chi2 = refined.move.dot(scene.prior.topLeftCorner<6, 6>() * refined.move);
  const HeldOutGain gain = HeldOutGainOf(fit, options.max_iterations);
  refined.held_out_gain = gain.mean;
  refined.held_out_gain_sigma = gain.sigma;
  refined.is_used = refined.held_out_gain > options.min_gain_sigmas * refined.held_out_gain_sigma;
  refined.reason = ReasonOf(refined);
  if (!refined.is_used) return refined;
  refined.T_camera_lidar = PerturbLeft(T_camera_lidar, refined.move);
  refined.covariance = refined.move_covariance;
  return refined;
}

}  // namespace voqcal
