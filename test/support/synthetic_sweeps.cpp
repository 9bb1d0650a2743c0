#include "support/synthetic_sweeps.hpp"

#include <cmath>

namespace voqcal::test {
namespace {

constexpr double kDegree = M_PI / 180.0;

bool IsDark(const Eigen::Vector3d& point_board_m) {
  const double square_m = TestBoard().square_m;
  const auto column = static_cast<int>(std::floor(point_board_m.x() / square_m));
  const auto row = static_cast<int>(std::floor(point_board_m.y() / square_m));
  return (column + row) % 2 == 0;
}

// Where the ray from the origin meets the board's plane.
double RangeToPlaneM(const Eigen::Isometry3d& T_lidar_board, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = T_lidar_board.linear().col(2);
  return normal.dot(T_lidar_board.translation()) / normal.dot(direction);
}

// The returns of a sweep on the board at `T_lidar_board`.
PointCloud SweepOn(const Eigen::Isometry3d& T_lidar_board,
                   const LidarFaults& faults,
                   Random* random) {
  constexpr double kAzimuthStepRad = 0.4 * kDegree;
  const std::vector<double> ring_offsets_m = RingOffsetsM(faults);
  const BoardSpec board = TestBoard();
  PointCloud cloud;
  cloud.has_intensity = cloud.has_ring = true;
  for (std::size_t ring = 0; ring < kNumRings; ++ring) {
    const double elevation_rad = (2 * static_cast<int>(ring) - 15) * kDegree;
    for (double azimuth_rad = -0.9; azimuth_rad < 0.9; azimuth_rad += kAzimuthStepRad) {
      const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad),
                                      std::sin(elevation_rad));
      const double range_m = RangeToPlaneM(T_lidar_board, direction);
      const Eigen::Vector3d hit_board_m = T_lidar_board.inverse() * (range_m * direction);
      if (std::abs(hit_board_m.x()) > board.width_m / 2) continue;
      if (std::abs(hit_board_m.y()) > board.height_m / 2) continue;
      const bool is_dark = IsDark(hit_board_m);
      const double measured_m = range_m + faults.common_m +
                                (is_dark ? 0.5 : -0.5) * faults.dark_step_m + ring_offsets_m[ring] +
                                faults.noise_m * random->Normal();
      LidarPoint point;
      point.position_m = (measured_m * direction).cast<float>();
      point.intensity = is_dark ? 1.0F : 60.0F;
      point.ring = static_cast<std::uint16_t>(ring);
      cloud.points.push_back(point);
    }
  }
  return cloud;
}

void Move(const Eigen::Vector3d& by_m, BoardPose* pose) {
  pose->centre_m += by_m;
  for (Eigen::Vector3d& corner_m : pose->corners_m) corner_m += by_m;
}

}  // namespace

std::vector<double> RingOffsetsM(const LidarFaults& faults) {
  Random random(faults.ring_seed);
  std::vector<double> offsets_m(kNumRings);
  double sum_m = 0.0;
  for (double& offset_m : offsets_m) {
    offset_m = faults.ring_sigma_m * random.Normal();
    sum_m += offset_m;
  }
  for (double& offset_m : offsets_m) offset_m -= sum_m / kNumRings;
  return offsets_m;
}

std::vector<BoardSample> SamplesWithSweeps(const SyntheticSamplesOptions& scene,
                                           const LidarFaults& faults) {
  Random random(1000 + scene.seed);
  auto samples = SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    const Eigen::Isometry3d T_lidar_board =
        scene.T_camera_lidar.inverse() * TransformFromPose(sample.camera.pose);
    sample.lidar.points_lidar_m = SweepOn(T_lidar_board, faults, &random);
    Move(faults.lift_m * Eigen::Vector3d::UnitZ(), &sample.lidar.pose);
  }
  return samples;
}

Matrix6d CovarianceOf(const BoardNoise& noise, const Eigen::Vector3d& centre_m) {
  const Eigen::Vector3d ray = centre_m.normalized();
  const Eigen::Matrix3d along = ray * ray.transpose();
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>().diagonal().setConstant(noise.rotation_rad * noise.rotation_rad);
  covariance.bottomRightCorner<3, 3>() =
      noise.across_m * noise.across_m * (Eigen::Matrix3d::Identity() - along) +
      noise.along_m * noise.along_m * along;
  return covariance;
}

void AddCameraNoise(const BoardNoise& noise, Random* random, BoardSample* sample) {
  BoardPose& pose = sample->camera.pose;
  const Eigen::Vector3d ray = pose.centre_m.normalized();
  const Eigen::Vector3d normals = random->NormalVector();
  Vector6d delta;
  delta << noise.rotation_rad * random->NormalVector(),
      noise.across_m * (normals - normals.dot(ray) * ray) + noise.along_m * normals.dot(ray) * ray;
  pose = PoseFromTransform(PerturbLeft(TransformFromPose(pose), delta), TestBoard());
  pose.covariance = CovarianceOf(noise, pose.centre_m);
}

}  // namespace voqcal::test
