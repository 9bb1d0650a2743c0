#pragma once

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal::test {

/// A board, a camera that looks forwards and slightly askew, and faults switched off.
struct SimulatedRig {
  BoardSpec board;
  CameraModel camera;
  SimulationOptions options;
};

inline CameraModel SmallCamera(LensModel lens) {
  CameraModel camera;
  camera.lens = lens;
  camera.width_px = 802;  // not a multiple of anything
  camera.height_px = 501;
  camera.fx_px = 450.0;
  camera.fy_px = 452.0;
  camera.cx_px = 404.0;
  camera.cy_px = 246.0;
  switch (lens) {
    case LensModel::kEquidistant:
      camera.distortion = {-0.054, -0.0784, 0.096, -0.0515};
      break;
    case LensModel::kPlumbBob:
      camera.distortion = {-0.25, 0.08, 0.0005, -0.0003, -0.01};
      break;
    case LensModel::kRational:
      camera.distortion = {0.4, 0.05, 0.0004, -0.0002, 0.002, 0.75, 0.1, 0.01};
      break;
  }
  return camera;
}

/// The same view with half the pixels on each side, for tests that need no sharp corners.
inline CameraModel HalfSize(CameraModel camera) {
  camera.width_px /= 2;
  camera.height_px /= 2;
  camera.fx_px /= 2;
  camera.fy_px /= 2;
  camera.cx_px /= 2;
  camera.cy_px /= 2;
  return camera;
}

inline SimulatedRig CleanRig(LensModel lens = LensModel::kPlumbBob) {
  SimulatedRig rig;
  rig.board.width_m = 0.61;
  rig.board.height_m = 0.85;
  rig.board.square_m = 0.095;
  rig.board.num_corners_x = 5;
  rig.board.num_corners_y = 7;
  rig.board.pattern_offset_x_m = 0.002;
  rig.camera = SmallCamera(lens);
  Eigen::Matrix3d R_camera_forward;  // camera axes from lidar axes: right, down, forward
  R_camera_forward << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::AngleAxisd askew(0.03, Eigen::Vector3d(1, 2, 3).normalized());
  rig.options.T_camera_lidar.linear() = askew.toRotationMatrix() * R_camera_forward;
  rig.options.T_camera_lidar.translation() = Eigen::Vector3d(0.05, -0.12, -0.08);
  rig.options.num_poses = 8;
  rig.options.range_noise_m = 0.0;
  rig.options.ring_bias_m = 0.0;
  rig.options.dark_bias_m = 0.0;
  rig.options.intensity_noise = 0.0;
  rig.options.beam_divergence_rad = 0.0;
  rig.options.pointing_noise_rad = 0.0;
  rig.options.dropout = 0.0;
  rig.options.image_noise = 0.0;
  return rig;
}

/// A time in the middle of a stop.
inline double TimeAtStopS(const SimulationOptions& options, int stop) {
  return stop * (options.hold_s + options.move_s) + options.hold_s / 2;
}

}  // namespace voqcal::test
