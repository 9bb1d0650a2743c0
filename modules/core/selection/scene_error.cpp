#include "core/selection/scene_error.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/board/metres_per_pixel.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// L of one pose.
Matrix6d InformationOf(const BoardSample& sample,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar,
                       const NominalNoise& nominal) {
  const PoseDifference difference = DifferenceOf(sample, camera, T_camera_lidar, nominal);
  return difference.J.transpose() * difference.C.llt().solve(difference.J);
}

}  // namespace

SceneErrorPredictor::SceneErrorPredictor(const std::vector<BoardSample>& scene,
                                         const CameraModel& camera,
                                         const Eigen::Isometry3d& T_camera_lidar,
                                         const NominalNoise& nominal) {
  const LeftPerturbation at(T_camera_lidar, Vector6d::Zero());
  int num_seen = 0;
  for (const BoardSample& sample : scene) {
    information_.push_back(InformationOf(sample, camera, T_camera_lidar, nominal));
    const Eigen::Vector3d centre_camera_m = T_camera_lidar * sample.lidar.pose.centre_m;
    if (!camera.IsInFront(centre_camera_m) || !camera.IsInFront(sample.camera.pose.centre_m)) {
      continue;
    }
    Matrix23d J_px_centre;
    ProjectWithJacobian(camera, centre_camera_m, &J_px_centre);
    const Eigen::Matrix<double, 2, 6> P_m = MetresPerPixel(sample.camera.pose, camera) *
                                            J_px_centre * at.PointJacobian(centre_camera_m);
    scene_m2_ += P_m.transpose() * P_m;
    ++num_seen;
  }
  if (num_seen > 0) scene_m2_ /= num_seen;
}

double SceneErrorPredictor::PredictMm(const std::array<int, 3>& poses) const {
  Matrix6d information = Matrix6d::Zero();
  for (const int pose : poses) information += information_[static_cast<std::size_t>(pose)];
  const Eigen::LLT<Matrix6d> cholesky(information);
  if (cholesky.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return kMmPerM * std::sqrt(cholesky.solve(scene_m2_).trace());
}

}  // namespace voqcal
