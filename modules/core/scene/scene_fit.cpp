#include "core/scene/scene_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "core/format.hpp"
#include "core/parallel.hpp"
#include "core/scene/scene_solver.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kNumFolds = 6;

SceneVector Solve(const SceneProblem& scene,
                  double scale,
                  int max_iterations,
                  SceneVector unknowns) {
  for (const auto& fields : scene.levels) {
    MinimiseAt(scene, fields, kAllSectors, scale, max_iterations, &unknowns);
  }
  return unknowns;
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
    unknowns = Solve(scene, trust->scale, max_iterations, unknowns);
    *trust = TrustAt(scene, unknowns);
  }
  MinimiseAt(scene, scene.Finest(), kAllSectors, trust->scale, max_iterations, &unknowns);
  return unknowns;
}

}  // namespace

SceneFit FitScene(const std::vector<SceneView>& views,
                  std::vector<SceneEdge> edges,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar,
                  const Matrix6d& covariance,
                  const SceneRefinementOptions& options) {
  SceneFit fit;
  fit.scene = ProblemOf(views, std::move(edges), camera, T_camera_lidar, covariance, options);
  fit.unknowns = Estimate(fit.scene, options.max_iterations, &fit.trust);
  return fit;
}

Matrix6d CovarianceOf(const SceneFit& fit, double shared_error_rad) {
  const SceneMatrix information =
      fit.scene.prior + fit.trust.scale * CurvatureAt(fit.scene, fit.unknowns);
  Matrix6d covariance = information.inverse().topLeftCorner<6, 6>();
  // Not beyond what was known without the scene.
  for (int i = 0; i < 3; ++i) {
    const double before = fit.scene.prior.topLeftCorner<6, 6>().inverse()(i, i);
    covariance(i, i) = std::min(before, covariance(i, i) + shared_error_rad * shared_error_rad);
  }
  return covariance;
}

HeldOutGain HeldOutGainOf(const SceneFit& fit, int max_iterations) {
  constexpr double kPinned = 1e12;  // information: 1 micron, 1 microradian
  SceneProblem without = fit.scene;
  without.prior.diagonal().head<6>().array() += kPinned;
  SceneVector back = fit.unknowns;
  back.head<6>().setZero();
  std::array<double, kNumFolds> gains{};
  ParallelFor(kNumFolds, [&](std::size_t fold) {
    const Sectors held_out = (1U << fold) | (1U << (fold + kNumFolds));
    const auto fitted = [&](const SceneProblem& scene, SceneVector start) {
      const Sectors others = kAllSectors & ~held_out;
      MinimiseAt(scene, scene.Finest(), others, fit.trust.scale, max_iterations, &start);
      return start;
    };
    gains[fold] = MeanSurprise(fit.scene, held_out, fitted(without, back)) -
                  MeanSurprise(fit.scene, held_out, fitted(fit.scene, fit.unknowns));
  });
  HeldOutGain gain;
  for (const double each : gains) gain.mean += each / kNumFolds;
  double variance = 0;
  for (const double each : gains) {
    variance += (each - gain.mean) * (each - gain.mean) / (kNumFolds - 1.0);
  }
  gain.sigma = std::sqrt(variance / kNumFolds);
  return gain;
}

double GainOf(const SceneFit& fit, const std::vector<int>& axes) {
  SceneVector unknowns = fit.unknowns;
  for (const int axis : axes) unknowns[axis] = 0;
  return MeanSurprise(fit.scene, kAllSectors, unknowns) -
         MeanSurprise(fit.scene, kAllSectors, fit.unknowns);
}

Eigen::Vector3d ChanceFalls(const SceneFit& fit) {
  constexpr double kStepRad = 0.1 * kRadPerDeg;
  constexpr int kNumSteps = 30;
  constexpr std::size_t kNumWays = 6;  // about three axes, both ways
  std::array<double, kNumWays> falls{};
  ParallelFor(kNumWays, [&](std::size_t way) {
    const double step_rad = way % 2 == 0 ? kStepRad : -kStepRad;
    double highest = 0;
    for (int i = 0; i <= kNumSteps; ++i) {
      SceneVector turned = fit.unknowns;
      turned[static_cast<int>(way) / 2] += i * step_rad;
      const double surprise = MeanSurprise(fit.scene, kAllSectors, turned);
      highest = std::max(highest, surprise);
      falls[way] = std::max(falls[way], highest - surprise);
    }
  });
  return {std::max(falls[0], falls[1]), std::max(falls[2], falls[3]), std::max(falls[4], falls[5])};
}

std::string TooFewEdges(int num_scenes, int num_edges) {
  return num_scenes == 0 ? "no scene was kept with the samples"
                         : Format("only %d depth edges lie in the images", num_edges);
}

}  // namespace voqcal
