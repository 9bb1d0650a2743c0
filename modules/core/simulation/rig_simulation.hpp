#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/simulation/scan_pattern.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// One lidar of a simulated rig. The rig's frame is that of the hall, z up.
struct SimulatedLidar {
  std::string name;
  Eigen::Isometry3d T_rig_lidar = Eigen::Isometry3d::Identity();  ///< The truth.
  ScanOptions scan;
};

/// One camera of it.
struct SimulatedCamera {
  std::string name;
  Eigen::Isometry3d T_camera_rig = Eigen::Isometry3d::Identity();  ///< The truth.
  CameraModel model;
};

/// Of those, the one of that name.
/// @throws std::invalid_argument if there is none.
template <typename Sensor>
std::size_t IndexOfName(const std::vector<Sensor>& sensors, const std::string& name) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].name == name) return i;
  }
  throw std::invalid_argument("no simulated sensor is named " + name);
}

/// A simulated rig of any number of sensors in one world.
struct RigSimulationOptions {
  /// Room, script, faults and noise; where its one lidar and camera are does not count.
  SimulationOptions world;
  std::vector<SimulatedLidar> lidars;
  std::vector<SimulatedCamera> cameras;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The world of Simulation with many sensors: each sees the same board in the same room at the same
/// time, with faults and noise of its own. A pure function of options and time.
///
/// Cameras take turns in having the board before them, and the lidars that share views with one in
/// being able to see it there; who else sees it, does.
class RigSimulation {
 public:
  /// @throws std::invalid_argument if `options` or `board` have Problems(), or if a camera shares
  ///     no view with any lidar.
  RigSimulation(const RigSimulationOptions& options, const BoardSpec& board);
  ~RigSimulation();

  double DurationS() const;
  Eigen::Isometry3d T_rig_board(double time_s) const;  // NOLINT: named for its frames
  bool IsStill(double time_s) const;

  /// Whether a sensor, by its number, has the board whole before it, facing it and unhidden.
  bool LidarSees(std::size_t lidar, double time_s) const;
  bool CameraSees(std::size_t camera, double time_s) const;

  PointCloud Sweep(std::size_t lidar, double time_s) const;

  /// Paints the room of a camera when it is first asked, which takes seconds.
  cv::Mat Image(std::size_t camera, double time_s);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voqcal
