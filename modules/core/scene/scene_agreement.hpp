#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_refinement.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// When scenes without any board contradict an extrinsic.
struct SceneAgreementOptions {
  // 1 sigma of what may have happened to the extrinsic.
  double turn_prior_rad = 0.0087266463;  ///< 0.5 deg
  double shift_prior_m = 0.02;
  // An axis known no better than this is left open...
  double max_turn_sigma_rad = 0.0034906585;  ///< 0.2 deg
  double max_shift_sigma_m = 0.015;
  // ... and disagrees beyond these and beyond so many of its standard errors.
  double turn_tolerance_rad = 0.0026179939;  ///< 0.15 deg
  double shift_tolerance_m = 0.02;
  double num_sigmas = 3.0;
  SceneRefinementOptions refinement;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

enum class Agreement { kAgrees, kDisagrees, kCannotTell };
std::string ToString(Agreement agreement);  ///< "agrees", "disagrees", "cannot tell".

struct SceneAgreement {
  Agreement all = Agreement::kCannotTell;  ///< Disagrees if an axis does; agrees if a turn does.
  std::array<Agreement, 6> axes{};
  Vector6d asked = Vector6d::Zero();  ///< PerturbLeft by it is what the scene asks for.
  Vector6d sigma = Vector6d::Zero();
  SceneRefinement refinement;  ///< From the checked extrinsic and the prior.
};

/// Where the scenes' edges want the extrinsic, by RefineByScene from a prior about it.
/// @throws std::invalid_argument if `options` has Problems().
SceneAgreement CheckAgreement(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar,
                              const SceneAgreementOptions& options);

}  // namespace voqcal
