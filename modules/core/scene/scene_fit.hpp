#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_problem.hpp"
#include "core/scene/scene_refinement.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// Where scenes and a prior want an extrinsic, with all that it takes to ask further.
struct SceneFit {
  SceneProblem scene;
  SceneTrust trust;
  SceneVector unknowns = SceneVector::Zero();
};

/// Minimises RefineByScene's cost.
/// @param edges  SceneEdgesInView of the same views and extrinsic.
SceneFit FitScene(const std::vector<SceneView>& views,
                  std::vector<SceneEdge> edges,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar,
                  const Matrix6d& covariance,
                  const SceneRefinementOptions& options);

/// Of the fitted extrinsic, as its cost bends; not wider than what was known without the scene.
Matrix6d CovarianceOf(const SceneFit& fit, double shared_error_rad);

/// How much better parts of the scene fit that were left out.
struct HeldOutGain {
  double mean = 0;  ///< Of the surprise.
  double sigma = 0;
};

/// Each sixth of the scene by what the others give, against where the extrinsic was.
HeldOutGain HeldOutGainOf(const SceneFit& fit, int max_iterations);

/// How much less the surprise is than with some axes (0 to 5) put back to where they were.
double GainOf(const SceneFit& fit, const std::vector<int>& axes);

/// By how much the surprise falls where it has no reason to: for a turn about each axis the largest
/// fall on the way outward from the fit, up to 3 deg. Where scan lines that are far apart cross
/// edges that lie along them, such hollows are as deep as what a real turn gains, and all parts of
/// the scene share them: neither its curvature nor their scatter shows that.
Eigen::Vector3d ChanceFalls(const SceneFit& fit);

/// Why scenes tell nothing, in words.
std::string TooFewEdges(int num_scenes, int num_edges);

}  // namespace voqcal
