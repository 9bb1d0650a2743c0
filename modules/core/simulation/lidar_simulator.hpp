#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/lidar/point_cloud.hpp"
#include "core/simulation/beam_rays.hpp"
#include "core/simulation/board_prop.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/scan_pattern.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// What of a sweep falls on the board.
struct BoardHits {
  int num_points = 0;
  int num_rings = 0;  ///< Zero if the sensor has no rings.
};

/// A lidar in the room.
///
/// A beam is a cone. Where it meets surfaces of different depth it answers as real ones do: with
/// the stronger echo if they are farther apart than it can blend, else with a range in between.
class LidarSimulator {
 public:
  /// @param T_room_lidar  where it stands, and how: any way up.
  LidarSimulator(const SimulationOptions& options,
                 const BoardSpec& board,
                 const Room& room,
                 const Eigen::Isometry3d& T_room_lidar = Eigen::Isometry3d::Identity());

  PointCloud Sweep(const Eigen::Isometry3d& T_lidar_board, std::int64_t frame_us) const;

  /// The truth about the same sweep: returns whose beam's centre ends on the board.
  BoardHits CountBoardHits(const Eigen::Isometry3d& T_lidar_board, std::int64_t frame_us) const;

 private:
  /// What a beam would read without noise.
  struct Echo {
    double range_m = 0.0;
    double albedo = 0.0;
    double bias_m = 0.0;     ///< By the shade of the board's square.
    double nearest_m = 0.0;  ///< Where the first of the beam's rays ends.
  };
  struct Moving;  ///< Board and stand at one time.
  struct Hit;     ///< Where one ray of a beam ends.

  /// Where a beam that is said to go in `direction` goes by chance: two standard normal numbers.
  Eigen::Vector3d Astray(const Eigen::Vector3d& direction,
                         const std::pair<double, double>& normals) const;
  std::vector<int> SolidsNear(const Eigen::Vector3d& direction) const;
  Hit CastMoving(const Eigen::Vector3d& direction, const Moving& moving) const;
  Hit Cast(const Eigen::Vector3d& direction,
           const Moving* moving,
           const std::vector<int>& solids) const;
  Echo CastBeam(const Eigen::Vector3d& direction, const Moving* moving) const;
  Echo EchoWithMoving(const Eigen::Vector3d& direction,
                      const Moving& moving,
                      const Echo& room_echo) const;
  Echo EchoOfMixture(std::vector<Hit>* hits) const;
  Echo EchoOf(const Hit& hit) const;
  std::vector<Echo> RoomEchoes(const std::vector<ScanBeam>& beams) const;

  SimulationOptions options_;
  BoardSpec board_;
  BoardFace face_;
  Room room_;
  Eigen::Isometry3d T_room_lidar_;
  BeamRays rays_;
  std::vector<ViewCone> solid_cones_;  ///< Where each of the room's solids can be met.
  std::vector<double> emitter_bias_m_;
  std::vector<ScanBeam> beams_;    ///< Of every sweep, if the pattern repeats.
  std::vector<Echo> room_echoes_;  ///< Of each of them in the room without the board.
};

}  // namespace voqcal
