#pragma once

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/simulation/simulation.hpp"
#include "images/jpeg.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "rig/rig.hpp"
#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"

namespace voqcal::test {

/// A rig to be simulated in seconds: four near stops, a small camera, one frame of each stop.
inline Rig TinySimulatedRig() {
  Rig rig;
  rig.name = "tiny";
  rig.board = TestBoard();
  rig.camera = SmallCamera(LensModel::kEquidistant);
  rig.simulation.T_camera_lidar = TestExtrinsic();
  rig.simulation.num_poses = 4;
  rig.simulation.max_distance_m = 2.5;
  rig.sample_collector.num_still_frames = 1;
  return rig;
}

template <typename Message>
void WriteEvent(const std::string& channel, const Message& message, LogWriter* log) {
  log->Write({0, message.utime, channel, EncodeMessage(message)});
}

/// A recording of the simulated rig with nothing but the middles of its stops:
/// sample_collector.num_still_frames frames of each, 0.1 s apart, as its drivers would send them.
inline void WriteStopsLog(const Rig& rig, const std::filesystem::path& path) {
  const Simulation simulation(rig.simulation, rig.board, rig.camera);
  LogWriter log(path);
  std::int32_t seq = 0;
  for (int stop = 0; stop < rig.simulation.num_poses; ++stop) {
    for (int i = 0; i < rig.sample_collector.num_still_frames; ++i) {
      const double time_s = stop * (rig.simulation.hold_s + rig.simulation.move_s) +
                            rig.simulation.hold_s / 2 + 0.1 * i;
      const std::int64_t utime = kSyntheticEpochUtime + std::llround(time_s * 1e6);
      const auto jpeg = EncodeJpeg(simulation.Image(time_s), rig.camera_driver.jpeg_quality);
      WriteEvent(rig.channels.lidar_points, ToMessage(simulation.Sweep(time_s), utime, seq), &log);
      WriteEvent(rig.channels.camera_image, EncodedToMessage(jpeg, utime, seq), &log);
      ++seq;
    }
  }
}

}  // namespace voqcal::test
