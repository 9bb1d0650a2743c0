#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/guidance/expected_sample.hpp"

namespace voqcal {

/// Where a person is asked to hold the board. The defaults are what detectors and arms can do.
struct PlacementLimits {
  double min_distance_m = 1.2;  ///< Of the board's centre from the camera.
  double max_distance_m = 5.0;
  /// Of either sensor's ray on the board. More slant would tell more, were plates without
  /// thickness and beams without width: in simulated sessions 50 degrees end up worse than 35.
  double max_incidence_rad = 35.0 * M_PI / 180.0;
  double image_margin = 0.03;   ///< The outline stays so far inside, share of the shorter side.
  double min_square_px = 12.0;  ///< Least distance of two neighbouring corners in the image.
  int min_rows = 6;             ///< The lidar has so many rows on the board.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Where the board is, by what one would tell who holds it.
struct Placement {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double distance_m = 0.0;  ///< Of its centre from the camera.
  double yaw_rad = 0.0;    ///< From facing the camera: its left side (in the image) comes nearer...
  double pitch_rad = 0.0;  ///< ...and then its top does.
  /// About its normal from upright; as a diamond, whose edges all cross upright's level lines.
  double turn_rad = M_PI / 4;
};

/// T_camera_board of a board that is held so.
/// @param up_camera  direction of upright.
/// @return nothing where the lens has no ray, or where it is less than 10 degrees from up or down:
/// nothing is upright there.
std::optional<Eigen::Isometry3d> PoseOf(const Placement& placement,
                                        const CameraModel& camera,
                                        const Eigen::Vector3d& up_camera);

/// The placement of a board wherever it is. Its angles are meaningless where PoseOf has nothing.
Placement PlacementOf(const Eigen::Isometry3d& T_camera_board,
                      const CameraModel& camera,
                      const Eigen::Vector3d& up_camera);

/// Whether both sensors see the whole board well: within the limits, in the image and in the
/// lidar's field of view, from the front. Rows on the board are not looked at.
bool IsInView(const Eigen::Isometry3d& T_camera_board,
              const Eigen::Isometry3d& T_camera_lidar,
              const BoardSpec& board,
              const CameraModel& camera,
              const SensorExpectation& expectation,
              const PlacementLimits& limits);

}  // namespace voqcal
