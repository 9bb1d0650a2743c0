#include "core/scene/scene_cost.hpp"

#include <algorithm>
#include <cmath>
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

double SurpriseAt(const SceneEdge& edge,
                  const std::vector<EdgeField>& fields,
                  const CameraModel& camera,
                  const LeftPerturbation& at,
                  double outset_rad,
                  Eigen::Matrix<double, 1, kSceneParameters>* J) {
  const Eigen::Vector3d true_lidar_m = edge.position_lidar_m - outset_rad * edge.outward_lidar_m;
  const Eigen::Vector3d point_camera_m = at.T_camera_lidar() * true_lidar_m;
  if (J != nullptr) J->setZero();
  if (!camera.IsInFront(point_camera_m)) return EdgeField::kNothingSeen;
  if (J == nullptr) return fields[edge.view].At(camera.Project(point_camera_m), nullptr);
  Matrix23d J_px_point;
  const Eigen::Vector2d pixel_px = ProjectWithJacobian(camera, point_camera_m, &J_px_point);
  Eigen::RowVector2d J_px;
  const double surprise = fields[edge.view].At(pixel_px, &J_px);
  const Eigen::RowVector3d J_point_m = J_px * J_px_point;
  J->head<6>() = J_point_m * at.PointJacobian(point_camera_m);
  (*J)[6] = -J_point_m.dot(at.T_camera_lidar().linear() * edge.outward_lidar_m);
  return surprise;
}

}  // namespace voqcal
