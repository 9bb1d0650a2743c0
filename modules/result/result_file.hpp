#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/diagnosis.hpp"
#include "core/assessment/lens_correction.hpp"
#include "core/assessment/predicted_error.hpp"
#include "core/assessment/scene_check.hpp"
#include "core/assessment/score_bins.hpp"
#include "core/assessment/scores.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// Name of the result in a session's folder.
inline constexpr char kResultName[] = "extrinsic.yaml";

/// A sample that the result was not made from, and why.
struct RejectedSample {
  std::int64_t id = 0;
  std::string reason;
};

/// A sample of which one of the lidar's runners-up was taken for the board, and why.
struct ExchangedSample {
  std::int64_t id = 0;
  int candidate = 0;  ///< Of its runners-up: 1 is the first.
  std::string reason;
};

/// The VOQ average that the refinement started from.
struct AveragedPart {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Vector6d spread =
      Vector6d::Zero();  ///< Of the kept sets: [rotation_rad; translation_m], left side.
  int num_sets = 0;
  int num_kept = 0;  ///< Within the z-score.
};

/// Which bytes the result is made from. No wall-clock time: the file is the same each run.
struct MadeFrom {
  std::string log_sha256;  ///< Of the session's samples.lcm.
  std::string rig_sha256;
  std::string version;  ///< Of voqcal.
};

/// Everything that extrinsic.yaml says.
struct CalibrationResult {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera side).
  Matrix6d covariance = Matrix6d::Zero();
  RefineMethod method = RefineMethod::kAverage;  ///< That T_camera_lidar comes from.
  std::vector<MethodTrial> trials;               ///< The scores that chose it.
  AveragedPart averaged;
  LidarBias lidar_bias;                     ///< Removed from the boards before they are scored.
  SceneScore held_out;                      ///< Each sample by the extrinsic refined without it.
  SceneScore in_sample;                     ///< Flatters: the same samples made the extrinsic.
  SceneScore of_average;                    ///< The VOQ average on all samples.
  std::vector<ScoreBin> held_out_by_cell;   ///< Of the image.
  std::vector<ScoreBin> held_out_by_range;  ///< From the camera.
  std::vector<PredictedError> predicted;    ///< Out to 50 m.
  SceneCheck scene_check;
  Diagnosis diagnosis;
  /// For who can correct the intrinsics too; nothing else of the result uses it.
  LensCorrection lens_correction;
  /// Median over the accepted samples of e_dim, the errors of the lidar's four edge lengths summed.
  double e_dim_mm = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::int64_t> used_ids;
  std::vector<RejectedSample> rejected;
  std::vector<ExchangedSample> exchanged;
  MadeFrom made_from;
};

/// The text of extrinsic.yaml. The same result gives the same bytes; numbers read back exactly.
std::string ToYaml(const CalibrationResult& result);

/// `path`; in a folder, which is then a result's, the file in it.
std::filesystem::path ResultFileAt(const std::filesystem::path& path);

/// T_camera_lidar of such a file (ResultFileAt), or of any YAML file with
///     T_camera_lidar: {matrix: 4 rows of 4} or {quaternion_xyzw, translation_m}
/// Other keys are not looked at. Rotations that were rounded (by up to 1e-3) are made exact.
///
/// @throws std::runtime_error naming file, line, key, rule and value: no such key, not a rigid
///     transform, or a matrix and a quaternion that contradict each other.
Eigen::Isometry3d ReadExtrinsic(const std::filesystem::path& path);

/// The same of a text that errors call `name`.
Eigen::Isometry3d ExtrinsicOf(const std::string& text, const std::string& name);

/// made_from.log_sha256 of such a text: of which samples it is.
/// @throws std::runtime_error if it has none.
std::string LogSha256Of(const std::string& text, const std::string& name);

}  // namespace voqcal
