#include "support/synthetic_samples.hpp"

#include <cmath>

namespace voqcal::test {
namespace {

// The board in the camera frame: its face (board z) to the camera, a diamond, tilted.
Eigen::Isometry3d RandomBoardPose(const SyntheticSamplesOptions& options, Random* random) {
  const double depth_m = 2.2 + options.spread * random->Uniform(-0.7, 0.8);
  const double x_m = options.spread * depth_m * random->Uniform(-0.4, 0.4);
  const double y_m = options.spread * depth_m * random->Uniform(-0.2, 0.2);
  const Eigen::Vector3d tilt_axis(random->Uniform(-1, 1), random->Uniform(-1, 1), 0);
  const double tilt_rad = options.max_tilt_rad * random->Uniform(0.3, 1.0);
  Eigen::Matrix3d R_camera_facing;  // board x right, y up, z towards the camera
  R_camera_facing << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() =
      ExpSO3(tilt_rad * tilt_axis.normalized()) * R_camera_facing * ExpSO3({0, 0, M_PI / 4});
  T_camera_board.translation() = Eigen::Vector3d(x_m, y_m, depth_m);
  return T_camera_board;
}

LidarBoard SeenByLidar(const Eigen::Isometry3d& T_camera_board,
                       const SyntheticSamplesOptions& options,
                       Random* random) {
  Vector6d noise;
  noise << options.lidar_rotation_noise_rad * random->NormalVector(),
      options.lidar_centre_noise_m * random->NormalVector();
  const Eigen::Isometry3d T_lidar_board =
      PerturbLeft(options.T_camera_lidar.inverse() * T_camera_board, noise);
  LidarBoard lidar;
  lidar.pose = PoseFromTransform(T_lidar_board, TestBoard());
  lidar.edge_lengths_m = TestBoard().EdgeLengthsM();
  for (double& length_m : lidar.edge_lengths_m) length_m += options.edge_noise_m * random->Normal();
  return lidar;
}

}  // namespace

double Random::Uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
}

double Random::Normal() {  // Box and Muller
  const double radius = std::sqrt(-2.0 * std::log(Uniform(0, 1)));
  return radius * std::cos(2.0 * M_PI * Uniform(0, 1));
}

Eigen::Vector3d Random::NormalVector() {
  const double x = Normal();
  const double y = Normal();
  return {x, y, Normal()};
}

std::size_t Random::Index(std::size_t n) { return engine_() % n; }

BoardSpec TestBoard() {
  BoardSpec board;
  board.width_m = 0.61;
  board.height_m = 0.85;
  board.square_m = 0.095;
  board.num_corners_x = 5;
  board.num_corners_y = 7;
  board.pattern_offset_x_m = 0.002;
  return board;
}

CameraModel TestCamera() {
  CameraModel camera;
  camera.lens = LensModel::kEquidistant;
  camera.width_px = 1920;
  camera.height_px = 1208;
  camera.fx_px = 1176.93;
  camera.fy_px = 1177.72;
  camera.cx_px = 962.275;
  camera.cy_px = 612.725;
  camera.distortion = {-0.0540096, -0.0784275, 0.0959641, -0.0515253};
  return camera;
}

Eigen::Isometry3d TestExtrinsic() {
  Eigen::Matrix3d
      R_camera_lidar;  // lidar: x forward, y left, z up; camera: x right, y down, z forward
  R_camera_lidar << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() = ExpSO3({0.02, -0.03, 0.01}) * R_camera_lidar;
  T_camera_lidar.translation() = Eigen::Vector3d(0.05, -0.12, -0.08);
  return T_camera_lidar;
}

std::vector<BoardSample> SynthesizeSamples(const SyntheticSamplesOptions& options) {
  Random random(options.seed);
  std::vector<BoardSample> samples;
  for (int i = 0; i < options.num_samples; ++i) {
    const Eigen::Isometry3d T_camera_board = RandomBoardPose(options, &random);
    const Eigen::Isometry3d T_camera_other = RandomBoardPose(options, &random);
    BoardSample sample;
    sample.id = i + 1;
    sample.utime = sample.id * 1'000'000;
    sample.camera.pose = PoseFromTransform(T_camera_board, TestBoard());
    sample.lidar =
        SeenByLidar(i < options.num_outliers ? T_camera_other : T_camera_board, options, &random);
    if (i >= options.num_samples - options.num_half_turned) {
      sample.lidar.pose = TurnedByHalf(sample.lidar.pose);
    }
    samples.push_back(sample);
  }
  return samples;
}

std::vector<const BoardSample*> Pointers(const std::vector<BoardSample>& samples) {
  std::vector<const BoardSample*> pointers;
  for (const BoardSample& sample : samples) pointers.push_back(&sample);
  return pointers;
}

}  // namespace voqcal::test
