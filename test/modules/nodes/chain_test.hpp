#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messaging/convert_board.hpp"
#include "modules/nodes/node_test.hpp"

namespace voqcal::test {

/// Samples of a lidar and a camera as good as real ones, so that sets and sizes differ.
inline std::vector<BoardSample> NoisySamples(int num_samples) {
  SyntheticSamplesOptions options;
  options.num_samples = num_samples;
  options.lidar_rotation_noise_rad = 0.005;
  options.lidar_centre_noise_m = 0.005;
  options.edge_noise_m = 0.005;
  return SynthesizeSamples(options);
}

/// The stages behind the sample collector, each of which reads CALIB_SAMPLES.
class ChainTest : public ::testing::Test {
 protected:
  static samples_t SamplesMessage(const std::vector<BoardSample>& samples,
                                  std::int64_t revision,
                                  const std::string& log_sha256 = "log's hash") {
    return ToMessage(samples, revision, true, log_sha256);
  }
  void SendSamples(const std::vector<BoardSample>& samples,
                   std::int64_t revision,
                   const std::string& log_sha256 = "log's hash") {
    Send(&bus_, rig_.channels.calib_samples, SamplesMessage(samples, revision, log_sha256));
  }
  /// A message that decodes, with a point whose scan line is missing.
  static samples_t BrokenSamples(std::int64_t revision) {
    samples_t message = SamplesMessage(NoisySamples(4), revision);
    message.samples[0].lidar.num_points = 1;
    message.samples[0].lidar.points.assign(1, std::vector<float>(4));
    message.samples[0].lidar.num_rings = 2;
    message.samples[0].lidar.rings.resize(2);
    return message;
  }
  /// Lets a stage compute, and hands on what it publishes.
  template <typename Node>
  void Step(Node* node) {
    EXPECT_FALSE(node->Step());
    HandleAll(&bus_);
  }

  Rig rig_ = TestRig();
  Bus bus_{"memq://"};
};

}  // namespace voqcal::test
