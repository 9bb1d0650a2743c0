#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal::test {

/// Numbers that are the same on every machine; the standard's distributions are not.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double Uniform(double low, double high);
  double Normal();                   ///< Mean 0, deviation 1.
  Eigen::Vector3d NormalVector();    ///< Three of these.
  std::size_t Index(std::size_t n);  ///< 0 .. n - 1.

 private:
  std::mt19937 engine_;
};

/// The real session's board and fisheye camera, and a transform much like its.
BoardSpec TestBoard();
CameraModel TestCamera();
Eigen::Isometry3d TestExtrinsic();

/// Samples of a board held as a diamond at many places and tilts in the camera's view.
struct SyntheticSamplesOptions {
  Eigen::Isometry3d T_camera_lidar = TestExtrinsic();  ///< The truth.
  int num_samples = 30;
  double max_tilt_rad = 0.6;  ///< Of the board against facing the camera; 0: all parallel.
  double spread = 1.0;        ///< Share of the view that the centres fill; 0: one place.
  double lidar_rotation_noise_rad = 0.0;  ///< 1 sigma of each axis of the lidar's board pose...
  double lidar_centre_noise_m = 0.0;      ///< ...and of its centre.
  double edge_noise_m = 0.0;              ///< 1 sigma of each measured edge length.
  int num_outliers = 0;     ///< So many of the first samples: the lidar saw another board.
  int num_half_turned = 0;  ///< So many of the last: the lidar's corners start opposite.
  std::uint32_t seed = 1;
};
std::vector<BoardSample> SynthesizeSamples(const SyntheticSamplesOptions& options);

std::vector<const BoardSample*> Pointers(const std::vector<BoardSample>& samples);

}  // namespace voqcal::test
