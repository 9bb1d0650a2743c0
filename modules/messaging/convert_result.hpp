#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/scores.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/estimation/average.hpp"
#include "core/estimation/set_extrinsic.hpp"
#include "core/selection/voq.hpp"
#include "voqcal/chosen_candidate_t.hpp"
#include "voqcal/extrinsic_averaged_t.hpp"
#include "voqcal/extrinsic_refined_t.hpp"
#include "voqcal/lidar_bias_t.hpp"
#include "voqcal/pose_score_t.hpp"
#include "voqcal/rigid_transform_t.hpp"
#include "voqcal/samples_t.hpp"
#include "voqcal/scene_score_t.hpp"
#include "voqcal/set_extrinsic_t.hpp"
#include "voqcal/transform_t.hpp"
#include "voqcal/voq_set_t.hpp"

namespace voqcal {

// All exact but for a rotation, which is a matrix here and a quaternion there: equal to rounding
// (about 1e-16), and the same bits on each run.

/// The quaternion has unit length and w >= 0.
transform_t ToMessage(const Eigen::Isometry3d& T_target_source);
/// @throws MessageError if the quaternion is not of unit length or a number is not finite.
Eigen::Isometry3d FromMessage(const transform_t& message);

/// For other LCM systems: bot_core's order w x y z.
rigid_transform_t RigidTransformMessage(const Eigen::Isometry3d& T_target_source,
                                        std::int64_t utime);

/// @param sample_ids  id of each sample that the set's indices refer to.
voq_set_t ToMessage(const VoqSet& set, const std::vector<std::int64_t>& sample_ids);
/// @throws MessageError if the set has a sample that `sample_ids` has not.
VoqSet FromMessage(const voq_set_t& message, const std::vector<std::int64_t>& sample_ids);

chosen_candidate_t ToMessage(const ExchangedSample& exchanged);
/// Takes for each sample the candidate that was chosen for it.
/// @throws MessageError if a sample or a candidate that was chosen is not there.
void TakeChosen(const std::vector<chosen_candidate_t>& chosen, std::vector<BoardSample>* samples);
/// The samples of the message, with the candidates that were chosen.
/// @throws MessageError as TakeChosen does.
std::vector<BoardSample> SamplesAsChosen(const samples_t& message,
                                         const std::vector<chosen_candidate_t>& chosen);

/// @param reason  why it was dropped; empty if `is_kept`.
set_extrinsic_t ToMessage(const SetExtrinsic& extrinsic,
                          const voq_set_t& set,
                          bool is_kept,
                          const std::string& reason);
/// @throws MessageError for an unknown status or a broken transform.
SetExtrinsic FromMessage(const set_extrinsic_t& message);

/// The average and its spread with each set's result; `sets` and `extrinsics` go together.
/// utime, revision, problem and inconsistent samples are left to the caller.
extrinsic_averaged_t ToMessage(const AveragedExtrinsic& average,
                               const std::vector<voq_set_t>& sets,
                               const std::vector<SetExtrinsic>& extrinsics);
AveragedExtrinsic FromMessage(const extrinsic_averaged_t& message);

/// utime and revision are left to the caller.
extrinsic_refined_t ToMessage(const BestExtrinsic& best,
                              const std::vector<std::int64_t>& sample_ids);
/// All that the message carries: of the trials the scores without single poses, and of the
/// likelihood bias, uncertainty and noise.
/// @throws MessageError for an unknown method or a broken transform.
BestExtrinsic FromMessage(const extrinsic_refined_t& message);

lidar_bias_t ToMessage(const LidarBias& bias);
LidarBias FromMessage(const lidar_bias_t& message);

pose_score_t ToMessage(const PoseScore& score);
PoseScore FromMessage(const pose_score_t& message);

spread_t ToMessage(const Spread& spread);
Spread FromMessage(const spread_t& message);

/// Without the single poses, which scene_score_t does not carry.
scene_score_t ToMessage(const SceneScore& score);
SceneScore FromMessage(const scene_score_t& message);

}  // namespace voqcal
