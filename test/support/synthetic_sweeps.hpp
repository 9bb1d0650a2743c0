#pragma once

#include <cstdint>
#include <vector>

#include "core/board/board_sample.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// Faults of a lidar of 16 rings, 2 degrees apart.
struct LidarFaults {
  double common_m = 0.0;
  double dark_step_m = 0.0;
  double ring_sigma_m = 0.0;
  double noise_m = 0.0;  ///< 1 sigma of one return.
  double lift_m = 0.0;   ///< All outlines look higher by this.
  std::uint32_t ring_seed = 99;
};

constexpr std::size_t kNumRings = 16;

/// Of zero mean: the mean is the common offset's, by definition.
std::vector<double> RingOffsetsM(const LidarFaults& faults);

/// SynthesizeSamples with the returns of one sweep on each board.
std::vector<BoardSample> SamplesWithSweeps(const SyntheticSamplesOptions& scene,
                                           const LidarFaults& faults);

/// How far a sensor's boards are off, 1 sigma each, and as their covariances say.
struct BoardNoise {
  double rotation_rad = 0.0;
  double across_m = 0.0;  ///< Of the centre, across the sensor's ray...
  double along_m = 0.0;   ///< ...and along it.
};

/// Moves the camera's board by noise and notes its covariance.
void AddCameraNoise(const BoardNoise& noise, Random* random, BoardSample* sample);

/// The covariance that goes with `noise` for a board at `centre_m`.
Matrix6d CovarianceOf(const BoardNoise& noise, const Eigen::Vector3d& centre_m);

}  // namespace voqcal::test
