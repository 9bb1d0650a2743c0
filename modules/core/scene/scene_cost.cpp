#include "core/scene/scene_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/parallel.hpp"

namespace voqcal {
namespace {

// An edge lies anywhere between two rays: what it tells, against one whose rays are dense.
double WeightOf(const DepthEdge& edge) {
  constexpr double kSharpRad = 0.002;  // about an image's edge, blurred
  const double share = edge.step_rad / kSharpRad;
  return 1.0 / (1.0 + share * share / 12.0);  // variance of a uniform distribution
}

bool IsInImage(const Eigen::Vector3d& point_camera_m, const CameraModel& camera) {
  return camera.IsInFront(point_camera_m) && camera.Contains(camera.Project(point_camera_m));
}

struct ProjectedEdge {
  Eigen::Vector3d point_camera_m;
  std::optional<Eigen::Vector2d> pixel_px;  // none behind the camera
  Matrix23d J_px_point;                     // if asked for
};

ProjectedEdge Projected(const SceneEdge& edge, const EdgeLookup& lookup, bool with_jacobian) {
  ProjectedEdge projected;
  const Eigen::Vector3d true_lidar_m =
      edge.position_lidar_m - lookup.outset_rad * edge.outward_lidar_m;
  projected.point_camera_m = lookup.at.T_camera_lidar() * true_lidar_m;
  projected.pixel_px = ProjectIfInFront(
      lookup.camera, projected.point_camera_m, with_jacobian ? &projected.J_px_point : nullptr);
  return projected;
}

// And its derivative, a row, unless that is null.
double SurpriseAt(const SceneEdge& edge,
                  const ProjectedEdge& projected,
                  const EdgeLookup& lookup,
                  EdgeField::Patch* patch,
                  double* J_row) {
  const EdgeField& field = lookup.fields[edge.view];
  if (J_row == nullptr) {
    return projected.pixel_px ? field.At(*projected.pixel_px, patch, nullptr)
                              : EdgeField::kNothingSeen;
  }
  Eigen::Map<Eigen::Matrix<double, 1, kSceneParameters>> J(J_row);
  J.setZero();
  if (!projected.pixel_px) return EdgeField::kNothingSeen;
  Eigen::RowVector2d J_px;
  const double surprise = field.At(*projected.pixel_px, patch, &J_px);
  const Eigen::RowVector3d J_point_m = J_px * projected.J_px_point;
  J.head<6>() = J_point_m * lookup.at.PointJacobian(projected.point_camera_m);
  J[6] = -J_point_m.dot(lookup.at.T_camera_lidar().linear() * edge.outward_lidar_m);
  return surprise;
}

}  // namespace

std::vector<SceneEdge> SceneEdgesInView(const std::vector<SceneView>& views,
                                        const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_lidar) {
  // Each with its azimuth in the camera, by which the sectors are cut.
  std::vector<std::pair<double, SceneEdge>> seen_at;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const DepthEdge& seen : views[view].edges) {
      const Eigen::Vector3d position_m = seen.position_lidar_m.cast<double>();
      const Eigen::Vector3d position_camera_m = T_camera_lidar * position_m;
      if (!IsInImage(position_camera_m, camera)) continue;
      SceneEdge edge;
      edge.position_lidar_m = position_m;
      edge.outward_lidar_m = position_m.norm() * seen.outward_lidar.cast<double>();
      edge.weight = WeightOf(seen);
      edge.view = view;
      seen_at.emplace_back(std::atan2(position_camera_m.x(), position_camera_m.z()), edge);
    }
  }
  std::stable_sort(seen_at.begin(), seen_at.end(), [](const auto& a, const auto& b) {
    return a.first < b.first;
  });
  std::vector<SceneEdge> edges;
  for (auto& [azimuth_rad, edge] : seen_at) {
    edge.sector = static_cast<int>(edges.size() * kNumSceneSectors / seen_at.size());
    edges.push_back(edge);
  }
  return edges;
}

std::vector<EdgeField> MakeEdgeFields(const std::vector<SceneView>& views, double blur_px) {
  std::vector<EdgeField> fields(views.size());
  ParallelFor(views.size(), [&](std::size_t i) { fields[i] = EdgeField(views[i], blur_px); });
  return fields;
}

void SurprisesAt(const SceneEdge* const* edges,
                 std::size_t num,
                 const EdgeLookup& lookup,
                 EdgeField::Patch* patches,
                 double* surprises,
                 double* J_rows) {
  constexpr std::size_t kNumAtOnce = 64;
  std::array<ProjectedEdge, kNumAtOnce> projected;
  const auto patch_of = [&](std::size_t i) { return patches != nullptr ? patches + i : nullptr; };
  for (std::size_t begin = 0; begin < num; begin += kNumAtOnce) {
    const std::size_t end = std::min(num, begin + kNumAtOnce);
    // What must be fetched from far is asked for before any of it is waited for.
    for (std::size_t i = begin; i < end; ++i) {
      ProjectedEdge& edge = projected[i - begin];
      edge = Projected(*edges[i], lookup, J_rows != nullptr);
      if (edge.pixel_px) lookup.fields[edges[i]->view].Prefetch(*edge.pixel_px, patch_of(i));
    }
    for (std::size_t i = begin; i < end; ++i) {
      double* J = J_rows != nullptr ? J_rows + kSceneParameters * i : nullptr;
      surprises[i] = SurpriseAt(*edges[i], projected[i - begin], lookup, patch_of(i), J);
    }
  }
}

}  // namespace voqcal
