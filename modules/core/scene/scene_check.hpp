#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// When the scene's own edges contradict an extrinsic.
struct SceneCheckOptions {
  int min_edges = 300;         ///< Fewer depth edges in the image judge nothing.
  double min_contrast = 0.05;  ///< The peak's score is that much above far perturbations'.
  double max_sigma_rad =
      0.0087266463;  ///< An axis known no better than this (0.5 deg) is left open.
  /// An offset about an axis disagrees beyond this (0.2 deg), half a pixel of a sweep...
  double tolerance_rad = 0.0034906585;
  double num_sigmas = 3.0;  ///< ...and beyond so many of its standard errors,
  /// if turning back costs so many standard errors of the score; else the scene does not say.
  double min_gain_sigmas = 2.0;
  SceneViewOptions view;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// The score of a perturbed extrinsic.
struct SceneProbe {
  Vector6d delta = Vector6d::Zero();  ///< PerturbLeft of the checked one: one entry is not zero.
  double score = std::numeric_limits<double>::quiet_NaN();
};

enum class SceneVerdict { kNotJudged, kAgrees, kDisagrees };
std::string ToString(SceneVerdict verdict);  ///< "not judged", "agrees", "disagrees".

/// What the scene says of an extrinsic, without any target.
///
/// A score is the mean rank (0 to 1) of the image gradient under the background's depth edges: 0.5
/// for edges that have nothing to do with each other.
struct SceneCheck {
  SceneVerdict verdict = SceneVerdict::kNotJudged;
  std::string reason;  ///< The verdict in a sentence.
  int num_scenes = 0;
  int num_edges = 0;  ///< Depth edges in the images, over all scenes.
  double score = std::numeric_limits<double>::quiet_NaN();
  double averaged_score = std::numeric_limits<double>::quiet_NaN();
  std::vector<SceneProbe>
      probes;  ///< Each axis both ways: 0.25, 0.5, 1, 2 deg; 25, 50, 100, 200 mm.
  // The best score of any turn about the camera, with the translation kept, and where it is.
  double peak_score = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d offset_rad = kUnknown;  ///< PerturbLeft by it leads to the peak.
  Eigen::Vector3d sigma_rad =
      kUnknown;  ///< By fitting halves of the scene, and by the lines' spacing.
  /// What the peak's score loses when it is turned back about an axis, in standard errors of that.
  Eigen::Vector3d gain_sigmas = kUnknown;
};

/// Scores `T_camera_lidar` on every scene at once, so that what stands still counts in each and
/// what moves averages out, and looks for a better one around it.
///
/// After Levinson and Thrun, Automatic Online Calibration of Cameras and Lasers (RSS 2013), which
/// scores depth edges on image edges; ranks instead of strengths let no single bright edge decide.
/// @throws std::invalid_argument if `options` has Problems().
SceneCheck CheckScene(const std::vector<SceneView>& views,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const Eigen::Isometry3d& T_camera_lidar_averaged,
                      const SceneCheckOptions& options);

}  // namespace voqcal
