#include "core/scene/scene_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/parallel.hpp"

namespace voqcal {
namespace {

using SectorGradients = std::array<SceneVector, kNumSceneSectors>;

EdgeLookup LookupAt(const SceneProblem& scene, const SceneVector& unknowns) {
  return {scene.Finest(),
          scene.camera,
          LeftPerturbation(scene.T_camera_lidar, unknowns.head<6>()),
          unknowns[6]};
}

// Of the weighted sum of surprises, by sector.
SectorGradients GradientsAt(const SceneProblem& scene, const SceneVector& unknowns) {
  const std::vector<const SceneEdge*> edges = EdgesIn(scene, kAllSectors);
  std::vector<double> surprises(edges.size());
  Eigen::Matrix<double, kSceneParameters, Eigen::Dynamic> gradient_of_edge(kSceneParameters,
                                                                           edges.size());
  SurprisesAt(edges.data(),
              edges.size(),
              LookupAt(scene, unknowns),
              nullptr,
              surprises.data(),
              gradient_of_edge.data());
  SectorGradients gradients;
  gradients.fill(SceneVector::Zero());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    gradients[static_cast<std::size_t>(edges[i]->sector)] +=
        edges[i]->weight * gradient_of_edge.col(static_cast<Eigen::Index>(i));
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

std::vector<const SceneEdge*> EdgesIn(const SceneProblem& scene, Sectors sectors) {
  std::vector<const SceneEdge*> edges;
  edges.reserve(scene.edges.size());
  for (const SceneEdge& edge : scene.edges) {
    if (IsIn(sectors, edge)) edges.push_back(&edge);
  }
  return edges;
}

double MeanSurprise(const SceneProblem& scene, Sectors sectors, const SceneVector& unknowns) {
  const std::vector<const SceneEdge*> edges = EdgesIn(scene, sectors);
  std::vector<double> surprises(edges.size());
  SurprisesAt(
      edges.data(), edges.size(), LookupAt(scene, unknowns), nullptr, surprises.data(), nullptr);
  double sum = 0;
  double sum_weights = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    sum += edges[i]->weight * surprises[i];
    sum_weights += edges[i]->weight;
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
