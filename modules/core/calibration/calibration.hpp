#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/diagnosis.hpp"
#include "core/assessment/enough.hpp"
#include "core/assessment/lens_correction.hpp"
#include "core/assessment/predicted_error.hpp"
#include "core/assessment/score_bins.hpp"
#include "core/assessment/scores.hpp"
#include "core/assessment/verdict.hpp"
#include "core/geometry/rigid.hpp"
#include "core/scene/scene_check.hpp"

namespace voqcal {

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

/// Everything that is said of a calibration: what it is, how good, and what it was made from.
struct Calibration {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera side): of where the lidar is,
  /// with the errors that the rig file may have of camera and board...
  Matrix6d covariance = Matrix6d::Zero();
  Matrix6d covariance_given_rig = Matrix6d::Zero();  ///< ...and if it has none.
  RefineMethod method = RefineMethod::kAverage;      ///< That T_camera_lidar comes from.
  std::string scene_note;           ///< What the scenes have to do with it, a sentence.
  std::vector<MethodTrial> trials;  ///< Every method's scores.
  AveragedPart averaged;
  LidarBias lidar_bias;  ///< Removed from the boards before they are scored.
  /// Of all chessboards against their rays (SharedErrors), about the camera's x and y; removed too.
  ChessboardTurn chessboard_turn;
  SceneScore held_out;                      ///< Each sample by the extrinsic refined without it.
  SceneScore in_sample;                     ///< Flatters: the same samples made the extrinsic.
  SceneScore of_average;                    ///< The VOQ average on all samples.
  std::vector<ScoreBin> held_out_by_cell;   ///< Of the image.
  std::vector<ScoreBin> held_out_by_range;  ///< From the camera.
  std::vector<PredictedError> predicted;    ///< Out to 50 m.
  Enough enough;
  SceneCheck scene_check;
  Diagnosis diagnosis;
  /// For who can correct the intrinsics too; nothing else of the result uses it.
  LensCorrection lens_correction;
  /// Median over the accepted samples of e_dim, the errors of the lidar's four edge lengths summed.
  double e_dim_mm = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::int64_t> used_ids;
  std::vector<RejectedSample> rejected;
  std::vector<ExchangedSample> exchanged;
};

/// Whether a calibration is good, in words: the one verdict that all pages and files say.
Verdict VerdictOf(const Calibration& calibration);

}  // namespace voqcal
