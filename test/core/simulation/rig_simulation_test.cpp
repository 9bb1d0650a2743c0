#include "core/simulation/rig_simulation.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>

#include "core/board/board_sample.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "simulated_rig.hpp"
#include "support/matchers.hpp"
#include "support/rig_of_five.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr int kNumPoses = 9;

RigSimulationOptions Clean() {
  RigSimulationOptions rig = test::RigOfFive();
  SimulationOptions& world = rig.world;
  world.num_poses = kNumPoses;
  world.range_noise_m = world.ring_bias_m = world.dark_bias_m = 0.0;
  world.beam_divergence_rad = world.pointing_noise_rad = world.dropout = 0.0;
  return rig;
}

double TimeAtStopS(const SimulationOptions& world, int stop) {
  return stop * (world.hold_s + world.move_s) + world.hold_s / 2;
}

int NumOnBoard(const PointCloud& sweep, const Eigen::Isometry3d& T_lidar_board) {
  const BoardSpec board = test::TestBoard();
  int count = 0;
  for (const LidarPoint& point : sweep.points) {
    const Eigen::Vector3d at = T_lidar_board.inverse() * point.position_m.cast<double>();
    count += std::abs(at.z()) < 1e-4 && std::abs(at.x()) < board.width_m / 2 &&
                     std::abs(at.y()) < board.height_m / 2
                 ? 1
                 : 0;
  }
  return count;
}

TEST(RigSimulation, ShowsOneBoardToAllLidars) {
  const RigSimulationOptions options = Clean();
  const RigSimulation rig(options, test::TestBoard());
  std::vector<int> num_seen(options.lidars.size(), 0);
  for (int stop = 0; stop < kNumPoses; ++stop) {
    const double time_s = TimeAtStopS(options.world, stop);
    ASSERT_TRUE(rig.IsStill(time_s));
    for (std::size_t lidar = 0; lidar < options.lidars.size(); ++lidar) {
      if (!rig.LidarSees(lidar, time_s)) continue;
      ++num_seen[lidar];
      const Eigen::Isometry3d T_lidar_board =
          options.lidars[lidar].T_rig_lidar.inverse() * rig.T_rig_board(time_s);
      EXPECT_GT(NumOnBoard(rig.Sweep(lidar, time_s), T_lidar_board), 50)
          << options.lidars[lidar].name << " at stop " << stop;
    }
  }
  EXPECT_EQ(num_seen[0], kNumPoses) << "it looks all round";
  EXPECT_GE(num_seen[1], 3);
  EXPECT_LT(num_seen[1], kNumPoses) << "it sees nothing behind it";
}

// The floor of a lidar that is tilted and lower is where that of the other one is.
TEST(RigSimulation, PutsAllLidarsIntoOneRoom) {
  const RigSimulationOptions options = Clean();
  const RigSimulation rig(options, test::TestBoard());
  for (std::size_t lidar = 0; lidar < options.lidars.size(); ++lidar) {
    double lowest_m = 0.0;
    for (const LidarPoint& point : rig.Sweep(lidar, 0.0).points) {
      const Eigen::Vector3d at_rig_m =
          options.lidars[lidar].T_rig_lidar * point.position_m.cast<double>();
      lowest_m = std::min(lowest_m, at_rig_m.z());
    }
    EXPECT_NEAR(lowest_m, -1.2, 1e-5) << options.lidars[lidar].name;
  }
}

TEST(RigSimulation, ShowsTheSameBoardToCameras) {
  constexpr std::size_t kLeft = 1;
  RigSimulationOptions options = Clean();
  options.cameras[kLeft].model = test::HalfSize(options.cameras[kLeft].model);
  RigSimulation rig(options, test::TestBoard());
  int stop = 0;
  while (stop < kNumPoses && !rig.CameraSees(kLeft, TimeAtStopS(options.world, stop))) ++stop;
  ASSERT_LT(stop, kNumPoses);
  const double time_s = TimeAtStopS(options.world, stop);
  const SimulatedCamera& left = options.cameras[kLeft];
  const auto seen = DetectCameraBoard(rig.Image(kLeft, time_s), left.model, test::TestBoard(), {});
  ASSERT_TRUE(seen);
  EXPECT_THAT(TransformFromPose(seen->pose),
              test::IsNear(left.T_camera_rig * rig.T_rig_board(time_s), 5e-3, 5e-3));
}

TEST(RigSimulation, TakesTurnsBeforeTheCameras) {
  const RigSimulationOptions options = Clean();
  const RigSimulation rig(options, test::TestBoard());
  for (int stop = 0; stop < kNumPoses; ++stop) {
    EXPECT_TRUE(
        rig.CameraSees(static_cast<std::size_t>(stop) % 3, TimeAtStopS(options.world, stop)));
  }
}

TEST(RigSimulation, RefusesARigThatIsNone) {
  RigSimulationOptions twice = Clean();
  twice.cameras[1].name = "roof";
  EXPECT_THAT(twice.Problems(), Contains("a sensor's name must be its own, is roof"));
  EXPECT_THROW(RigSimulation(twice, test::TestBoard()), std::invalid_argument);
  RigSimulationOptions blind = Clean();
  blind.lidars.erase(blind.lidars.begin());  // what is left looks ahead
  try {
    const RigSimulation rig(blind, test::TestBoard());
    FAIL() << "rear shares no view with bumper";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("camera rear"));
  }
}

}  // namespace
}  // namespace voqcal
