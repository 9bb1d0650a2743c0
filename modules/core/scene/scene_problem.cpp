#include "core/scene/scene_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/parallel.hpp"

namespace voqcal {
namespace {

using SectorGradients = std::array<SceneVector, kNumSceneSectors>;

// Of the weighted sum of surprises, by sector.
SectorGradients GradientsAt(const SceneProblem& scene, const SceneVector& unknowns) {
  const LeftPerturbation at(scene.T_camera_lidar, unknowns.head<6>());
  SectorGradients gradients;
  gradients.fill(SceneVector::Zero());
  Eigen::Matrix<double, 1, kSceneParameters> J;
  for (const SceneEdge& edge : scene.edges) {
    SurpriseAt(edge, scene.Finest(), scene.camera, at, unknowns[6], &J);
    gradients[static_cast<std::size_t>(edge.sector)] += edge.weight * J.transpose();
  }
  return gradients;
}

SceneVector Sum(const SectorGradients& gradients) {
  SceneVector sum = SceneVector::Zero();
  for (const SceneVector& gradient : gradients) sum += gradient;
  return sum;
}

// About what an edge's blur hides: differences so wide look past the pixels' grain.
SceneVector Steps() {
  SceneVector steps;
  steps << 0.001, 0.001, 0.002, 0.01, 0.01, 0.01, 0.0005;
  return steps;
}

// The scatter of the parts' gradients about their mean: what the sum's would be by chance.
SceneMatrix ScatterAt(const SceneProblem& scene, const SceneVector& unknowns) {
  const SectorGradients gradients = GradientsAt(scene, unknowns);
  const SceneVector mean = Sum(gradients) / kNumSceneSectors;
  SceneMatrix scatter = SceneMatrix::Zero();
  for (const SceneVector& gradient : gradients) {
    scatter += (gradient - mean) * (gradient - mean).transpose();
  }
  return scatter * kNumSceneSectors / (kNumSceneSectors - 1.0);
}

}  // namespace

// Mean surprise of the edges in the sectors, weighted.
double MeanSurprise(const SceneProblem& scene, Sectors sectors, const SceneVector& unknowns) {
  const LeftPerturbation at(scene.T_camera_lidar, unknowns.head<6>());
  double sum = 0;
  double sum_weights = 0;
  for (const SceneEdge& edge : scene.edges) {
    if (!IsIn(sectors, edge)) continue;
    sum += edge.weight * SurpriseAt(edge, scene.Finest(), scene.camera, at, unknowns[6], nullptr);
    sum_weights += edge.weight;
  }
  return sum / sum_weights;
}

// How the sum bends; made positive.
SceneMatrix CurvatureAt(const SceneProblem& scene, const SceneVector& unknowns) {
  const SceneVector step = Steps();
  SceneMatrix curvature;
  ParallelFor(kSceneParameters, [&](std::size_t parameter) {
    const int i = static_cast<int>(parameter);
    const SceneVector d = step[i] * SceneVector::Unit(i);
    curvature.col(i) =
        (Sum(GradientsAt(scene, unknowns + d)) - Sum(GradientsAt(scene, unknowns - d))) /
        (2 * step[i]);
  });
  // In units of the steps, so that no unit decides what is small.
  const SceneMatrix scaled =
      step.asDiagonal() * (0.5 * (curvature + curvature.transpose())) * step.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<SceneMatrix> eigen(scaled);
  constexpr double kFlat = 1e-12;  // where it bends nowhere, next to nothing is known
  const double least = std::max(kFlat, 1e-3 * eigen.eigenvalues().maxCoeff());
  const SceneVector values = eigen.eigenvalues().cwiseMax(least);
  const SceneMatrix positive =
      eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  const SceneVector unit = step.cwiseInverse();
  return unit.asDiagonal() * positive * unit.asDiagonal();
}

// k such that the gradients of k times the sum scatter as its curvature says, k^2 G = k H, summed
// over the unknowns in units of their steps.
SceneTrust TrustAt(const SceneProblem& scene, const SceneVector& unknowns) {
  const SceneMatrix H = CurvatureAt(scene, unknowns);
  const SceneMatrix G = ScatterAt(scene, unknowns);
  // a - 1; below nothing fits where it is, and the coarse levels have yet to find what does.
  constexpr double kLeastGain = 0.2;
  const double gain = std::max(kLeastGain, 1 / MeanSurprise(scene, kAllSectors, unknowns) - 1);
  SceneTrust trust;
  const SceneVector squares = Steps().cwiseAbs2();
  constexpr double kLeastScale = 1e-6;
  const double scale = H.diagonal().dot(squares) / G.diagonal().dot(squares);
  trust.scale = std::isfinite(scale) ? std::clamp(scale, kLeastScale, gain) : kLeastScale;
  trust.redundancy = gain / trust.scale;
  return trust;
}

}  // namespace voqcal
