#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal::test {

/// A box by its frame (in its middle) and half sizes.
struct SyntheticBox {
  Eigen::Isometry3d T_lidar_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_m = Eigen::Vector3d::Ones();
};

/// Truth and faults of one sweep: a board (and boxes) in front of a wall, above a floor.
struct SyntheticLidarBoardOptions {
  BoardSpec board{0.61, 0.85, 0.095, 5, 7, 0.0, 0.0};
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  bool has_board = true;
  double thickness_m = 0.0;
  double spill_m = 0.005;    ///< Beams this far past an edge still return from the board.
  double edge_blur_m = 0.0;  ///< Scale of a logistic scatter of the spill from beam to beam.
  bool has_wall = true;      ///< At x = 7 m; without it these beams return nothing.
  bool has_floor = true;     ///< At z = -1.3 m.
  std::vector<SyntheticBox> boxes;
  double noise_m = 0.0;   ///< 1 sigma of each range.
  int num_rings = 16;     ///< From -15 to 15 degrees.
  double step_deg = 0.2;  ///< Of azimuth.
  std::uint32_t seed = 1;
};

/// T_lidar_board of a board at `centre_m` that faces the lidar, then turned in its own frame: by
/// `roll` about its normal, and before that tilted about its y and x axes.
inline Eigen::Isometry3d FacingBoard(const Eigen::Vector3d& centre_m,
                                     double roll_deg,
                                     double tilt_y_deg = 0.0,
                                     double tilt_x_deg = 0.0) {
  constexpr double kRad = 3.14159265358979323846 / 180.0;
  Eigen::Matrix3d facing;
  facing.col(2) = -centre_m.normalized();
  facing.col(0) = Eigen::Vector3d::UnitZ().cross(facing.col(2)).normalized();
  facing.col(1) = facing.col(2).cross(facing.col(0));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = facing * Eigen::AngleAxisd(tilt_y_deg * kRad, Eigen::Vector3d::UnitY()) *
               Eigen::AngleAxisd(tilt_x_deg * kRad, Eigen::Vector3d::UnitX()) *
               Eigen::AngleAxisd(roll_deg * kRad, Eigen::Vector3d::UnitZ());
  T.translation() = centre_m;
  return T;
}

/// A Gaussian of unit sigma by Box and Muller: std::normal_distribution differs between libraries.
inline double UnitGaussian(std::mt19937* random) {
  const double u = (static_cast<double>((*random)()) + 0.5) / 4294967296.0;
  const double v = (static_cast<double>((*random)()) + 0.5) / 4294967296.0;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * 3.14159265358979323846 * v);
}

/// Range at which the unit ray enters the box; infinity if it misses.
inline double RangeToBox(const SyntheticBox& box, const Eigen::Vector3d& ray) {
  const Eigen::Isometry3d T_box_lidar = box.T_lidar_box.inverse();
  const Eigen::Vector3d from = T_box_lidar.translation();
  const Eigen::Vector3d along = T_box_lidar.linear() * ray;
  double enter_m = 0.0;
  double leave_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-box.half_m[axis] - from[axis]) / along[axis];
    const double b = (box.half_m[axis] - from[axis]) / along[axis];
    enter_m = std::max(enter_m, std::min(a, b));
    leave_m = std::min(leave_m, std::max(a, b));
  }
  return enter_m <= leave_m ? enter_m : std::numeric_limits<double>::infinity();
}

/// The front half of a sweep, ring by ring, with rings and intensities.
inline PointCloud SynthesizeLidarBoard(const SyntheticLidarBoardOptions& options) {
  constexpr double kRad = 3.14159265358979323846 / 180.0;
  std::vector<SyntheticBox> boxes = options.boxes;
  if (options.has_board) {
    SyntheticBox box{options.T_lidar_board,
                     {options.board.width_m / 2 + options.spill_m,
                      options.board.height_m / 2 + options.spill_m,
                      options.thickness_m / 2}};
    box.T_lidar_box.translation() -=
        options.T_lidar_board.linear().col(2) * options.thickness_m / 2;
    boxes.push_back(box);
  }
  std::mt19937 random(options.seed);
  PointCloud cloud;
  cloud.has_ring = cloud.has_intensity = true;
  const int num_steps = static_cast<int>(180.0 / options.step_deg);
  for (int ring = 0; ring < options.num_rings; ++ring) {
    const double elevation = (-15.0 + 30.0 * ring / (options.num_rings - 1)) * kRad;
    for (int step = 0; step < num_steps; ++step) {
      const double azimuth = (-90.0 + options.step_deg * (step + 0.37 * ring)) * kRad;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      double range_m = std::numeric_limits<double>::infinity();
      if (options.has_board && options.edge_blur_m > 0) {
        const double u = (static_cast<double>(random()) + 0.5) / 4294967296.0;
        const double spill_m = options.spill_m + options.edge_blur_m * std::log(u / (1.0 - u));
        boxes.back().half_m.x() = options.board.width_m / 2 + spill_m;
        boxes.back().half_m.y() = options.board.height_m / 2 + spill_m;
      }
      for (const SyntheticBox& box : boxes) range_m = std::min(range_m, RangeToBox(box, ray));
      if (options.has_wall && ray.x() > 0.05) range_m = std::min(range_m, 7.0 / ray.x());
      if (options.has_floor && ray.z() < 0) range_m = std::min(range_m, -1.3 / ray.z());
      range_m += options.noise_m * UnitGaussian(&random);
      if (!(range_m < 100.0)) continue;
      LidarPoint point;
      point.position_m = (range_m * ray).cast<float>();
      point.intensity = 50.0F;
      point.ring = static_cast<std::uint16_t>(ring);
      cloud.points.push_back(point);
    }
  }
  return cloud;
}

}  // namespace voqcal::test
