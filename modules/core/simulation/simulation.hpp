#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/simulation/scan_pattern.hpp"

namespace voqcal {

/// A simulated rig in a room: truth, script and sensor faults.
struct SimulationOptions {
  std::uint32_t seed = 1;
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();  ///< The truth.
  int num_poses = 40;   ///< Stops of the board; where it follows the guidance, at most.
  double hold_s = 1.0;  ///< How long the board is still at each stop.
  double move_s = 0.5;  ///< How long it moves between stops.
  /// Instead of the script a simulated person holds it where the guidance asks for (GuidedBoard).
  bool follows_guidance = false;
  double min_distance_m = 1.5;
  double max_distance_m = 4.5;
  // Room.
  bool has_clutter = false;         ///< People, tripods, doors and more furniture stand about.
  double second_board_scale = 0.0;  ///< Size of a second board, of the true one's; 0: none.
  // Lidar.
  ScanOptions scan;
  double range_noise_m = 0.01;  ///< 1 sigma of one return.
  double ring_bias_m =
      0.008;  ///< 1 sigma of the constant offset of each ring, where there are rings.
  double common_bias_m = 0.0;    ///< Constant offset of every range.
  double dark_bias_m = 0.0075;   ///< Dark squares read longer by this, bright ones shorter.
  double intensity_noise = 1.0;  ///< 1 sigma of one return's intensity; a white surface reads 100.
  double beam_divergence_rad = 0.003;  ///< Full width of a beam; mixed pixels come from it.
  /// 1 sigma of where a beam goes about where it says it goes: with it the edges of boards are as
  /// blurred as a real VLP-16's.
  double pointing_noise_rad = 0.0013;
  double dropout = 0.01;  ///< Share of beams without a return.
  // Camera.
  double image_noise = 2.0;    ///< 1 sigma, grey levels of 255.
  double image_blur_px = 0.5;  ///< 1 sigma of the lens' blur.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The simulated world: a room with walls, pillars and a board on a stand. A pure function of
/// options and time, so that two processes that simulate the same rig agree.
class Simulation {
 public:
  /// Paints the room and finds the stops; takes seconds for a large image.
  /// @throws std::invalid_argument if `options`, `board` or `camera` have Problems(), or if the
  ///     board fits nowhere into the view of both sensors.
  Simulation(const SimulationOptions& options, const BoardSpec& board, const CameraModel& camera);
  ~Simulation();

  /// From the first stop's begin to the last stop's end.
  double DurationS() const;

  /// Where the board truly is. Times outside [0, DurationS()] hold the first or last pose.
  Eigen::Isometry3d T_lidar_board(double time_s) const;  // NOLINT: named for its frames

  /// True while the board rests at a stop.
  bool IsStill(double time_s) const;

  /// One sweep that begins at `time_s`, without motion within the sweep. Rings, where
  /// the pattern has them, count from the lowest. Beams without a return are left out.
  PointCloud Sweep(double time_s) const;

  /// The image of an instant: 8-bit BGR, with lens distortion, blur and noise.
  cv::Mat Image(double time_s) const;

  /// The same with the board elsewhere than in the script.
  PointCloud Sweep(double time_s, const Eigen::Isometry3d& T_lidar_board) const;
  cv::Mat Image(double time_s, const Eigen::Isometry3d& T_lidar_board) const;

  /// Whether the board would be whole in the view of both sensors, in the room and unhidden.
  bool CanRestAt(const Eigen::Isometry3d& T_lidar_board) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace voqcal
