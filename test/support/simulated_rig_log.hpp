#pragma once

#include <cmath>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"
#include "core/simulation/simulation.hpp"
#include "rig/rig.hpp"
#include "support/simulated_log.hpp"

namespace voqcal::test {

/// A rig of several in one room, as seen from its first lidar. All lidars stand at one place: a
/// simulated room is drawn around its lidar.
struct SimulatedRig {
  struct Lidar {
    std::string name;
    double yaw_rad = 0.0;  ///< Of the first lidar's x, in this one's frame.
    ScanPattern pattern = ScanPattern::kVlp16;
  };
  struct Camera {
    std::string name;
    CameraModel model;
    Eigen::Isometry3d T_camera_first_lidar = Eigen::Isometry3d::Identity();
  };
  std::vector<Lidar> lidars;
  std::vector<Camera> cameras;
  SimulationOptions options;  ///< But for what each sensor has of its own.

  Eigen::Isometry3d T_lidar_first(std::size_t lidar) const {  // NOLINT: named for its frames
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() =
        Eigen::AngleAxisd(lidars[lidar].yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T;
  }

  /// The truth.
  Eigen::Isometry3d T_camera_lidar(std::size_t camera, std::size_t lidar) const {  // NOLINT
    return cameras[camera].T_camera_first_lidar * T_lidar_first(lidar).inverse();
  }
};

/// Two lidars and two cameras that look the same way; small, clean and quick.
inline SimulatedRig SmallSimulatedRig() {
  SimulatedRig rig;
  rig.lidars = {{"front", 0.0, ScanPattern::kSpinning64}, {"rear", 0.4, ScanPattern::kSpinning64}};
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
  T_right_left.linear() = ExpSO3({0.01, 0.05, -0.02});
  T_right_left.translation() = Eigen::Vector3d(-0.2, 0.01, 0.02);
  rig.cameras = {{"left", SmallCamera(LensModel::kEquidistant), TestExtrinsic()},
                 {"right", SmallCamera(LensModel::kPlumbBob), T_right_left * TestExtrinsic()}};
  rig.options.max_distance_m = 2.5;
  rig.options.ring_bias_m = 0.0;
  rig.options.dark_bias_m = 0.0;
  return rig;
}

/// One frame of every sensor at each of so many stops of the first camera; the others see the board
/// where it happens to be in their view.
inline void WriteRigLog(const SimulatedRig& rig,
                        const BoardSpec& board,
                        int num_stops,
                        const std::filesystem::path& path) {
  const auto options_of = [&rig, num_stops](std::size_t camera, std::uint32_t seed) {
    SimulationOptions options = rig.options;
    options.num_poses = num_stops;
    options.seed = seed;
    options.T_camera_lidar = rig.cameras[camera].T_camera_first_lidar;
    return options;
  };
  std::deque<Simulation> lidars;
  for (std::size_t i = 0; i < rig.lidars.size(); ++i) {
    SimulationOptions options = options_of(0, static_cast<std::uint32_t>(i + 1));
    options.scan.pattern = rig.lidars[i].pattern;
    lidars.emplace_back(options, board, rig.cameras[0].model);
  }
  std::deque<Simulation> cameras;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    cameras.emplace_back(options_of(i, 1), board, rig.cameras[i].model);
  }
  LogWriter log(path);
  for (int stop = 0; stop < num_stops; ++stop) {
    const double time_s = stop * (rig.options.hold_s + rig.options.move_s) + rig.options.hold_s / 2;
    const std::int64_t utime = kSyntheticEpochUtime + std::llround(time_s * 1e6);
    const Eigen::Isometry3d T_first_board = lidars[0].T_lidar_board(time_s);
    for (std::size_t i = 0; i < lidars.size(); ++i) {
      PointCloud cloud = lidars[i].Sweep(time_s, T_first_board);
      const Eigen::Isometry3f T_lidar_first = rig.T_lidar_first(i).cast<float>();
      for (LidarPoint& point : cloud.points) point.position_m = T_lidar_first * point.position_m;
      WriteEvent("LIDAR_POINTS_" + rig.lidars[i].name, ToMessage(cloud, utime, stop), &log);
    }
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const auto jpeg = EncodeJpeg(cameras[i].Image(time_s, T_first_board), 95);
      WriteEvent("CAMERA_IMAGE_" + rig.cameras[i].name, EncodedToMessage(jpeg, utime, stop), &log);
    }
  }
}

}  // namespace voqcal::test
