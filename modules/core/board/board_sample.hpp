#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/geometry/rigid.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// NaN: a vector that nobody has set is never a plausible one.
inline const Eigen::Vector3d kUnknown =
    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Where one sensor saw the board, in that sensor's frame.
struct BoardPose {
  Eigen::Vector3d centre_m = kUnknown;
  Eigen::Vector3d normal = kUnknown;  ///< Unit length, towards the sensor: board z.
  /// Of the outline, in BoardSpec's order.
  std::array<Eigen::Vector3d, 4> corners_m = {kUnknown, kUnknown, kUnknown, kUnknown};
  /// Of [rotation_rad; translation_m] of T_sensor_board, perturbed on the left (sensor) side at the
  /// board's centre. Zero if unknown (features that were read from a table).
  Matrix6d covariance = Matrix6d::Zero();
};

/// What a sweep showed of one side of the board's outline.
enum class SideView : std::uint8_t {
  kMeasured,  ///< Beams past it tell where the board ends.
  kJoined,    ///< Something touches the board there: ground, frame, post, wall, hand.
  kHidden,    ///< Something stands before it.
  kCutOff,    ///< The field of view, or a cropped cloud, ends before it.
  kGap,       ///< The sweep left a gap there.
};
std::string ToString(SideView view);  ///< "measured", "joined", ...

/// What the lidar board detector says of one board.
///
/// The pose is always whole: the known size completes what was measured. What no side and no plane
/// fixes is as uncertain as the returns leave it, since all of them lie on the board: a sighting of
/// the plane alone has a centre that may be off by half the board, and a turn about the normal that
/// may be anything, and its covariance says so.
struct LidarBoard {
  BoardPose pose;                   ///< In the lidar frame.
  std::array<SideView, 4> sides{};  ///< Of each edge, in BoardSpec's order.
  /// Each edge measured freely, not from the known size; NaN where a side at either of its ends is
  /// not measured.
  std::array<double, 4> edge_lengths_m{};
  double plane_rms_m = std::numeric_limits<double>::quiet_NaN();
  int num_beams = 0;            ///< Scan lines on the board; 0 if the scan has none.
  double log_likelihood = 0.0;  ///< Higher is better; ranks the candidates of one sweep.
  PointCloud points_lidar_m;    ///< The points on the board.
};

/// What lessens the trust in a sighting: a reason, one of a few, to be counted, and what was
/// measured.
struct SightingWarning {
  std::string reason;  ///< "blurred"
  std::string detail;  ///< "edge width 4.1 px, at most 3"
};

/// What the camera board detector says of one image.
struct CameraBoard {
  BoardPose pose;  ///< In the camera frame.
  /// Inner corners in BoardSpec::InnerCornersBoardM order; NaN: not seen.
  std::vector<Eigen::Vector2d> corners_px;
  double reprojection_rms_px = std::numeric_limits<double>::quiet_NaN();
  std::vector<SightingWarning> warnings;
};

/// One pose of the board, seen by both sensors: what calibration is made from.
struct BoardSample {
  std::int64_t id = 0;     ///< 1, 2, ... in the order of acceptance; never used again.
  std::int64_t utime = 0;  ///< Capture time of the first frame's sweep, us since the Unix epoch.
  /// Exposure time of the image paired with that sweep; 0 if unknown (features read from a table).
  std::int64_t camera_utime = 0;
  int num_frames = 1;  ///< Frames averaged.
  LidarBoard lidar;
  CameraBoard camera;
  /// What else in the lidar's sight might be the board, likeliest first: `lidar` is only the
  /// likeliest by its own looks.
  std::vector<LidarBoard> runners_up{};
};

/// How many sides of the board were measured: 4 is a whole sighting, 0 the plane alone.
int NumMeasuredSides(const LidarBoard& board);

/// T_sensor_board of a pose: the rotation nearest to its edges and normal, at its centre.
Eigen::Isometry3d TransformFromPose(const BoardPose& pose);

/// The pose whose centre, normal and corners `T_sensor_board` implies; its covariance is zero.
BoardPose PoseFromTransform(const Eigen::Isometry3d& T_sensor_board, const BoardSpec& board);

/// The same board, its axes turned half a turn about its normal (corner i becomes corner i + 2).
BoardPose TurnedByHalf(const BoardPose& pose);

/// The ids of samples, in order.
std::vector<std::int64_t> IdsOf(const std::vector<const BoardSample*>& samples);

/// The samples whose id is not in `left_out_ids`, in order; they point into `samples`.
std::vector<const BoardSample*> SamplesWithout(const std::vector<BoardSample>& samples,
                                               const std::vector<std::int64_t>& left_out_ids);

}  // namespace voqcal
