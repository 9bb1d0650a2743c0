#pragma once

#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"
#include "core/simulation/rig_simulation.hpp"
#include "support/simulated_log.hpp"

namespace voqcal::test {

/// Two lidars and two cameras that look the same way; small and quick.
inline RigSimulationOptions SmallRig() {
  RigSimulationOptions rig;
  rig.world.num_poses = 12;
  rig.world.max_distance_m = 2.5;
  rig.lidars.resize(2);
  rig.lidars[0].name = "front";
  rig.lidars[1].name = "rear";
  for (SimulatedLidar& lidar : rig.lidars) lidar.scan.pattern = ScanPattern::kSpinning64;
  rig.lidars[1].T_rig_lidar.linear() = ExpSO3({0.03, -0.05, 0.4});
  rig.lidars[1].T_rig_lidar.translation() = Eigen::Vector3d(0.2, -0.1, -0.15);
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
  T_right_left.linear() = ExpSO3({0.01, 0.05, -0.02});
  T_right_left.translation() = Eigen::Vector3d(-0.2, 0.01, 0.02);
  rig.cameras = {{"left", TestExtrinsic(), SmallCamera(LensModel::kEquidistant)},
                 {"right", T_right_left * TestExtrinsic(), SmallCamera(LensModel::kPlumbBob)}};
  return rig;
}

/// A recording of all sensors with nothing but one frame of each in the middle of each stop.
inline void WriteStopsLog(const RigSimulationOptions& rig,
                          const BoardSpec& board,
                          const std::filesystem::path& path) {
  RigSimulation simulation(rig, board);
  LogWriter log(path);
  for (int stop = 0; stop < rig.world.num_poses; ++stop) {
    const double time_s = stop * (rig.world.hold_s + rig.world.move_s) + rig.world.hold_s / 2;
    const std::int64_t utime = kSyntheticEpochUtime + std::llround(time_s * 1e6);
    for (std::size_t i = 0; i < rig.lidars.size(); ++i) {
      WriteEvent("LIDAR_POINTS_" + rig.lidars[i].name,
                 ToMessage(simulation.Sweep(i, time_s), utime, stop),
                 &log);
    }
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      const auto jpeg = EncodeJpeg(simulation.Image(i, time_s), 95);
      WriteEvent("CAMERA_IMAGE_" + rig.cameras[i].name, EncodedToMessage(jpeg, utime, stop), &log);
    }
  }
}

}  // namespace voqcal::test
