#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

struct SceneRefinementOptions {
  int min_edges = 300;  ///< Fewer depth edges in the images tell nothing.
  /// Of the reduced image, coarse to fine: the first finds an extrinsic that is that far off.
  std::vector<double> blurs_px = {6.0, 3.0, 1.5};
  double outset_prior_rad = 0.001;  ///< 1 sigma: how far surfaces reach beyond their ends.
  /// 1 sigma of what all edges share: sweep timing, beam, sampling. Added to each rotation.
  double shared_error_rad = 0.0004;
  /// Parts of the scene that were left out must fit better by so many standard errors.
  double min_gain_sigmas = 1.0;
  int max_iterations = 50;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// An extrinsic with what the scene adds to it.
///
/// A surprise is the mean of EdgeField over the depth edges: 1 for edges that have nothing to do
/// with each other, less the better they fit.
struct SceneRefinement {
  bool is_used = false;  ///< False: the transform and covariance are those that were given.
  std::string reason;    ///< Why so, a sentence.
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera side).
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  int num_scenes = 0;
  int num_edges = 0;
  double surprise_before = std::numeric_limits<double>::quiet_NaN();
  double surprise_after = std::numeric_limits<double>::quiet_NaN();
  /// How much better the refined extrinsic fits parts of the scene that it was refined without.
  double held_out_gain = std::numeric_limits<double>::quiet_NaN();
  double held_out_gain_sigma = std::numeric_limits<double>::quiet_NaN();
  /// How many edges err alike: each counts for one over this.
  double redundancy = std::numeric_limits<double>::quiet_NaN();
  double outset_rad = std::numeric_limits<double>::quiet_NaN();
  /// Where the scene and what was given want the extrinsic, PerturbLeft of the given one, and how
  /// well that is known; also if it is not used.
  Vector6d move = Vector6d::Zero();
  Matrix6d move_covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// How far the scene moves what was given, squared, over its covariance: about 6 is expected.
  double move_chi2 = std::numeric_limits<double>::quiet_NaN();
};

/// Refines an extrinsic that is known with a covariance by the scenes' edges: the background's
/// depth edges should lie on edges of the image.
///
/// Minimised, coarse to fine:
///     d' C^-1 d / 2 + outset^2 / (2 s^2) + k sum of w_i surprise_i(d, outset)
/// d: PerturbLeft of the given extrinsic, C: its covariance. Of ranks with density a r^(a-1), which
/// fits edges that coincide, -log is (a-1) times the surprise: k is that over the redundancy,
/// estimated by how the gradients of twelve parts of the scene scatter. The refinement is used if
/// parts of the scene that were left out fit better by it.
/// @throws std::invalid_argument if `options` has Problems().
SceneRefinement RefineByScene(const std::vector<SceneView>& views,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar,
                              const Matrix6d& covariance,
                              const SceneRefinementOptions& options);

}  // namespace voqcal
