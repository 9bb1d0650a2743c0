#pragma once

#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/metres_per_pixel.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/refine.hpp"

namespace voqcal {

/// How well an extrinsic fits one pose. All NaN if it puts the board where the camera cannot see
/// it, or if there is no extrinsic to score; all but the normal if the lidar did not measure where
/// the board's centre is (IsCentreMeasured).
struct PoseScore {
  double centre_px =
      std::numeric_limits<double>::quiet_NaN();  ///< Reprojection error of the board's centre.
  /// The same times the board's metres per pixel (MetresPerPixel): the paper's millimetres, whose
  /// scale it does not spell out.
  double centre_mm = std::numeric_limits<double>::quiet_NaN();
  /// Mean distance of the 4 outline corners in the camera frame, matched up to the board's
  /// half-turn.
  double corner_mm = std::numeric_limits<double>::quiet_NaN();
  /// Angle between the camera's normal and the rotated lidar normal.
  double normal_deg = std::numeric_limits<double>::quiet_NaN();
};

struct Spread {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double std = std::numeric_limits<double>::quiet_NaN();  ///< Population standard deviation.
  double max = std::numeric_limits<double>::quiet_NaN();
};

/// Over all poses of a scene; one score a sample, in order.
struct SceneScore {
  std::vector<PoseScore> poses;
  Spread centre_px, centre_mm, corner_mm, normal_deg;
};

/// The spread of each figure over the poses.
SceneScore SummariseScores(std::vector<PoseScore> poses);

PoseScore ScorePose(const BoardSample& sample,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar);

SceneScore ScoreScene(const std::vector<const BoardSample*>& samples,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar);

/// The geometric mean of the centres' error in the image and the corners' in space, mm: the one
/// sees what the camera is asked, the other also what it hardly sees. NaN without scores.
double CombinedErrorMm(const SceneScore& scene);

/// A sample that was held out, scored by what the others give; all NaN if they give nothing.
using ScoreByOthers = std::function<PoseScore(const BoardSample& held_out,
                                              const std::vector<const BoardSample*>& others)>;

/// Each sample held out in turn; `score` is called on several threads at once.
SceneScore ScoreHeldOut(const std::vector<const BoardSample*>& samples, const ScoreByOthers& score);

/// Each pose scored by the extrinsic refined without it, from the same start: what is held out is
/// the refinement. The start (the average over all poses) only says which minimum and which
/// half-turns are meant. A pose without which the refinement is not usable scores NaN: at least
/// four samples are needed.
SceneScore LeaveOneOutScore(const std::vector<const BoardSample*>& samples,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar_start,
                            const RefineOptions& options);

}  // namespace voqcal
