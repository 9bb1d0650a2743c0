#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/simulation/board_prop.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

constexpr double kMaxBeamElevationRad =
    15.0 * M_PI / 180.0;  ///< Of the VLP-16; the lowest is minus this.

/// A VLP-16 at the origin of the lidar frame: 16 rings at 2 degrees, 1800 columns a turn of 0.1 s,
/// from behind clockwise.
///
/// A beam is a cone. Where it meets surfaces of different depth it answers as real ones do: with
/// the stronger echo if they are farther apart than it can blend, else with a range in between.
class LidarSimulator {
 public:
  LidarSimulator(const SimulationOptions& options, const BoardSpec& board, const Room& room);

  PointCloud Sweep(const Eigen::Isometry3d& T_lidar_board, std::int64_t frame_us) const;

 private:
  /// What a beam would read without noise.
  struct Echo {
    double range_m = 0.0;
    double albedo = 0.0;
    double bias_m = 0.0;  ///< By the shade of the board's square.
  };
  struct Moving;  ///< Board and stand at one time.
  struct Hit;     ///< Where one ray of a beam ends.

  Hit Cast(const Eigen::Vector3d& direction, const Moving* moving) const;
  Echo CastBeam(int beam, const Moving* moving) const;
  Echo EchoOfMixture(std::vector<Hit>* hits) const;
  Echo EchoOf(const Hit& hit) const;

  SimulationOptions options_;
  BoardSpec board_;
  BoardFace face_;
  Room room_;
  std::array<double, 16> ring_bias_m_{};
  std::vector<Eigen::Vector3d> directions_;  ///< Of the beams, column by column, lowest ring first.
  std::vector<Echo> room_echoes_;            ///< Of each beam in the room without the board.
};

}  // namespace voqcal
