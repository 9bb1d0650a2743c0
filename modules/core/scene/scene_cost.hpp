#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/edge_field.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// The unknowns: [PerturbLeft of the start (6); outset_rad], the outset being how far beyond its
/// true end a surface answers to a beam that is wide, on either side alike.
constexpr int kSceneParameters = 7;
using SceneVector = Eigen::Matrix<double, kSceneParameters, 1>;
using SceneMatrix = Eigen::Matrix<double, kSceneParameters, kSceneParameters>;

/// One depth edge as the cost takes it.
struct SceneEdge {
  Eigen::Vector3d position_lidar_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward_lidar_m =
      Eigen::Vector3d::Zero();  ///< How it moves by the outset, 1 rad.
  double weight = 1.0;
  std::size_t view = 0;
  int sector = 0;
};

/// Parts of the scene that err independently, as its poses do not: they share what stands still.
constexpr int kNumSceneSectors = 12;

/// The depth edges that lie in the images, in sectors of equally many by azimuth.
std::vector<SceneEdge> SceneEdgesInView(const std::vector<SceneView>& views,
                                        const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_lidar);

/// Where edges are looked at: the fields of all views at one blur.
std::vector<EdgeField> MakeEdgeFields(const std::vector<SceneView>& views, double blur_px);

/// By which extrinsic, and in which fields.
struct EdgeLookup {
  const std::vector<EdgeField>& fields;
  const CameraModel& camera;
  LeftPerturbation at;
  double outset_rad = 0;
};

/// The surprises at `num` edges.
/// @param patches  one an edge, of its view's field; the same when the edges are asked again. Null
///     if they are not.
/// @param J_rows   their derivatives by the unknowns, a row each; may be null.
void SurprisesAt(const SceneEdge* const* edges,
                 std::size_t num,
                 const EdgeLookup& lookup,
                 EdgeField::Patch* patches,
                 double* surprises,
                 double* J_rows);

}  // namespace voqcal
