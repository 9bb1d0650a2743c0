#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_refinement.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// When scenes contradict an extrinsic, without any board.
struct SceneCheckOptions {
  // 1 sigma of what may have happened to the extrinsic.
  double turn_prior_rad = 0.0087266463;  ///< 0.5 deg
  double shift_prior_m = 0.02;
  // An axis known no better than this is left open...
  double max_turn_sigma_rad = 0.0017453293;  ///< 0.1 deg
  double max_shift_sigma_m = 0.015;
  // ... and disagrees beyond these and beyond so many of its standard errors...
  double turn_tolerance_rad = 0.0026179939;  ///< 0.15 deg
  double shift_tolerance_m = 0.02;
  double num_sigmas = 3.0;
  /// ... if the surprise falls by so many times what it falls by elsewhere for no reason.
  double min_gain_over_chance = 1.5;
  SceneViewOptions view;
  SceneRefinementOptions refinement;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

enum class Agreement { kCannotTell, kAgrees, kDisagrees };
std::string ToString(Agreement agreement);  ///< "agrees", "disagrees", "cannot tell".

/// The score of a perturbed extrinsic.
struct SceneProbe {
  Vector6d delta = Vector6d::Zero();  ///< PerturbLeft of the checked one: one entry is not zero.
  double score = std::numeric_limits<double>::quiet_NaN();
};

/// What scenes say of an extrinsic. Scores are MeanEdgeRank's.
struct SceneCheck {
  Agreement verdict = Agreement::kCannotTell;  ///< Disagrees if an axis does; agrees if turns do.
  std::string reason;                          ///< The verdict in a sentence.
  int num_scenes = 0;
  int num_edges = 0;  ///< Depth edges in the images, over all scenes.
  /// PerturbLeft by it is what the scenes ask for, within the priors of the options.
  Vector6d asked = Vector6d::Zero();
  /// Its standard errors.
  Vector6d sigma = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::array<Agreement, 6> axes{};
  double score = std::numeric_limits<double>::quiet_NaN();
  double asked_score = std::numeric_limits<double>::quiet_NaN();  ///< Of what they ask for.
  /// Each axis both ways: 0.25, 0.5, 1, 2 deg; 25, 50, 100, 200 mm.
  std::vector<SceneProbe> probes;
};

/// Where the scenes' edges want the extrinsic, by RefineByScene from a prior about it; all scenes
/// at once, so that what stands still counts in each and what moves averages out.
/// @throws std::invalid_argument if `options` has Problems().
SceneCheck CheckScene(const std::vector<SceneView>& views,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const SceneCheckOptions& options);

}  // namespace voqcal
