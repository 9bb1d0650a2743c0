#pragma once

#include <Eigen/Geometry>

#include <limits>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/refine.hpp"

namespace voqcal {

/// How well an extrinsic fits one pose.
struct PoseScore {
  double centre_px = 0.0;   ///< Reprojection error of the board's centre.
  double centre_mm = 0.0;   ///< The same times the board's metres per pixel, as the paper defines it.
  double corner_mm = 0.0;   ///< Mean distance of the 4 outline corners in the camera frame.
  double normal_deg = 0.0;  ///< Angle between the camera's normal and the rotated lidar normal.
};

struct Spread {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double std = std::numeric_limits<double>::quiet_NaN();  ///< Population standard deviation.
  double max = std::numeric_limits<double>::quiet_NaN();
};

/// Over all poses of a scene.
struct SceneScore {
  std::vector<PoseScore> poses;
  Spread centre_px, centre_mm, corner_mm, normal_deg;
};

/// Metres on the board per pixel at the board: mean length of the outline's two diagonals in metres
/// over their mean length in pixels.
double MetresPerPixel(const BoardPose& pose_camera, const CameraModel& camera);

PoseScore ScorePose(const BoardSample& sample,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar);

SceneScore ScoreScene(const std::vector<const BoardSample*>& samples,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar);

/// Each pose scored by the extrinsic refined without it, from the same start.
SceneScore LeaveOneOutScore(const std::vector<const BoardSample*>& samples,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar_start,
                            const RefineOptions& options);

}  // namespace voqcal
