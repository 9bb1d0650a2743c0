#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/joint_extrinsic.hpp"
#include "core/assessment/scores.hpp"
#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/average.hpp"
#include "core/estimation/refine.hpp"
#include "core/likelihood/likelihood.hpp"
#include "core/scene/scene_refinement.hpp"

namespace voqcal {

/// Where a published extrinsic comes from.
enum class RefineMethod {
  kAverage,       ///< The average over the chosen sets, as it is.
  kReprojection,  ///< RefineExtrinsic.
  kLikelihood,    ///< RefineByLikelihood.
  kJoint,         ///< RefineJointly: both of these and the scenes.
};

std::string ToString(RefineMethod method);  ///< "average", "reprojection", ...
/// Nothing for an unknown name.
std::optional<RefineMethod> RefineMethodFromString(const std::string& name);

struct RefinerOptions {
  /// Nothing: joint; where that fails, what generalises best to poses held out.
  std::optional<RefineMethod> method;
  RefineOptions reprojection;
  LikelihoodOptions likelihood;
  SceneRefinementOptions scene;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// How one method did on the data at hand.
struct MethodTrial {
  RefineMethod method = RefineMethod::kAverage;
  std::string problem;  ///< Why there is no result; empty if there is one.
  /// Each pose by the extrinsic refined without it, and with the lidar's faults removed as they
  /// were estimated without it. The average is not refined: its scores are of the samples that
  /// made it, which flatters it.
  SceneScore held_out;

  double ErrorMm() const { return CombinedErrorMm(held_out); }
};

/// The extrinsic to publish, and why.
struct BestExtrinsic {
  RefineMethod method = RefineMethod::kAverage;
  std::string problem;  ///< Why there is no extrinsic, a sentence; empty if there is one.
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera side): of where the lidar is,
  /// with the errors that the rig file may have of camera and board (CovarianceByRigErrors); NaN
  /// where the likelihood does not tell what they do...
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// ...and if it has none: of where points land in this camera's image, and of how the result
  /// repeats with this rig file, whose small errors make up for one another there.
  Matrix6d covariance_given_rig = covariance;
  double reprojection_rms_px = std::numeric_limits<double>::quiet_NaN();  ///< Of the centres.
  SceneScore held_out;  ///< The chosen method's; all NaN of the average, which holds none out.
  std::vector<MethodTrial> trials;  ///< Average, reprojection, likelihood, joint.
  /// What the likelihood found, also if another method was chosen; its status says if it did.
  LikelihoodExtrinsic likelihood;
  JointExtrinsic joint;    ///< Also if another method was chosen.
  std::string scene_note;  ///< What the scenes have to do with it, a sentence; empty: not asked.

  bool IsUsable() const { return problem.empty(); }
  /// The lidar's faults that go with the extrinsic: none, unless it is the likelihood's or joint.
  LidarBias Bias() const;
  /// How the chessboards are turned against their rays (SharedErrors): not estimated, unless it is
  /// the likelihood's or joint.
  ChessboardTurn chessboard_turn;
};

/// The sample with the boards as they would have been seen without the lidar's `bias` and the
/// chessboards' turn about the camera's x and y; its points are left out.
BoardSample CorrectedSample(const BoardSample& sample,
                            const LidarBias& bias,
                            const Eigen::Vector2d& chessboard_turn_rad);

/// Each sample so; the lidar's board as it is if `bias` has no fault that is observable.
std::vector<BoardSample> CorrectedSamples(const std::vector<const BoardSample*>& samples,
                                          const LidarBias& bias,
                                          const Eigen::Vector2d& chessboard_turn_rad);

/// ScoreScene of the CorrectedSamples.
SceneScore ScoreCorrected(const std::vector<const BoardSample*>& samples,
                          const CameraModel& camera,
                          const Eigen::Isometry3d& T_camera_lidar,
                          const LidarBias& bias,
                          const Eigen::Vector2d& chessboard_turn_rad);

/// Refines `average` by each method, and takes the joint one (or the one that the options name).
/// The likelihood needs points on most boards; without it and without scenes there is no joint one.
/// @param views  of the samples' scenes; may be empty.
/// @throws std::invalid_argument if `options` has Problems().
BestExtrinsic RefineBest(const std::vector<const BoardSample*>& samples,
                         const BoardSpec& board,
                         const CameraModel& camera,
                         const AveragedExtrinsic& average,
                         const std::vector<SceneView>& views,
                         const RefinerOptions& options);

}  // namespace voqcal
