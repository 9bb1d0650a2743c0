#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/scene/scene_cost.hpp"

namespace voqcal {

/// Parts of the scene, a bit for each.
using Sectors = unsigned;
constexpr Sectors kAllSectors = (1U << kNumSceneSectors) - 1;

inline bool IsIn(Sectors sectors, const SceneEdge& edge) {
  return (sectors >> edge.sector & 1U) != 0;
}

/// All that stays the same while an extrinsic is refined.
struct SceneProblem {
  std::vector<SceneEdge> edges;
  CameraModel camera;
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();  ///< Given.
  SceneMatrix prior = SceneMatrix::Zero();     ///< Information before the scene.
  std::vector<std::vector<EdgeField>> levels;  ///< Of all views, coarse to fine.

  const std::vector<EdgeField>& Finest() const { return levels.back(); }
};

/// Those in the sectors, in order.
std::vector<const SceneEdge*> EdgesIn(const SceneProblem& scene, Sectors sectors);

/// Mean surprise of the edges in the sectors, weighted.
double MeanSurprise(const SceneProblem& scene, Sectors sectors, const SceneVector& unknowns);

/// How the weighted sum of surprises bends; positive definite.
SceneMatrix CurvatureAt(const SceneProblem& scene, const SceneVector& unknowns);

/// How much the sum counts, and why.
struct SceneTrust {
  double scale = 0;       ///< The cost's k.
  double redundancy = 0;  ///< How many edges err alike.
};

/// By how the gradients of the sectors scatter.
SceneTrust TrustAt(const SceneProblem& scene, const SceneVector& unknowns);

}  // namespace voqcal
