#include "assessor/assessor_node.hpp"

#include <utility>
#include <vector>

#include <system_error>

#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"
#include "rig/atomic_file.hpp"

namespace voqcal {

AssessorNode::AssessorNode(const Rig& rig, Bus* bus, const std::filesystem::path& session_folder)
    : rig_(rig), bus_(*bus), session_folder_(session_folder) {
  std::error_code error;
  std::filesystem::create_directories(session_folder_, error);
  if (error) {
    throw std::runtime_error(session_folder_.string() +
                             ": cannot make the session's folder: " + error.message());
  }
  bus_.Subscribe<samples_t>(
      rig_.channels.calib_samples, Queue::kState, [this](const samples_t& m) { samples_ = m; });
  bus_.Subscribe<extrinsic_averaged_t>(rig_.channels.extrinsic_averaged,
                                       Queue::kState,
                                       [this](const extrinsic_averaged_t& m) { averaged_ = m; });
  bus_.Subscribe<extrinsic_refined_t>(rig_.channels.extrinsic_refined,
                                      Queue::kState,
                                      [this](const extrinsic_refined_t& m) { refined_ = m; });
}

std::string AssessorNode::State() const {
  if (!assessment_) return "waiting for samples and extrinsics";
  return assessment_->problem.empty() ? "running" : "waiting: " + assessment_->problem;
}

bool AssessorNode::Step() {
  if (!samples_ || !averaged_ || !refined_) return false;
  if (!IsMadeFrom(*samples_, *averaged_) || !IsMadeFrom(*samples_, *refined_)) return false;
  if (assessment_ && IsMadeFrom(*samples_, *assessment_)) return false;
  Assess();
  Count(problem().empty() ? "assessments" : "without a result");
  Republish();
  return false;
}

void AssessorNode::Republish() {
  if (assessment_) bus_.Publish(rig_.channels.calib_assessment, *assessment_);
}

void AssessorNode::Assess() {
  assessment_t assessment{};
  StampMadeFrom(*samples_, &assessment);
  assessment.problem = refined_->problem;
  result_.reset();
  if (assessment.problem.empty()) {
    result_ = Result();
    assessment.averaged_in_sample = ToMessage(result_->of_average);
    assessment.refined_in_sample = ToMessage(result_->in_sample);
    assessment.refined_held_out = ToMessage(result_->held_out);
    assessment.sample_ids = result_->used_ids;
    assessment.num_samples = static_cast<std::int32_t>(result_->used_ids.size());
    for (const PoseScore& pose : result_->held_out.poses) {
      assessment.held_out_centre_px.push_back(pose.centre_px);
      assessment.held_out_centre_mm.push_back(pose.centre_mm);
    }
    WriteFileAtomically(session_folder_ / kResultName, ToYaml(*result_));
  }
  assessment_ = std::move(assessment);
}

CalibrationResult AssessorNode::Result() const {
  const std::vector<BoardSample> all = FromMessage(*samples_);
  const std::vector<const BoardSample*> samples = SamplesWithout(all, averaged_->inconsistent_ids);

  CalibrationResult result;
  result.T_camera_lidar = FromMessage(refined_->T_camera_lidar);
  result.covariance =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(&refined_->covariance[0][0]);
  result.averaged.T_camera_lidar = FromMessage(averaged_->T_camera_lidar);
  result.averaged.spread = Eigen::Map<const Vector6d>(averaged_->spread);
  result.averaged.num_sets = averaged_->num_sets;
  for (const set_extrinsic_t& set : averaged_->sets) result.averaged.num_kept += set.is_kept;

  result.held_out = LeaveOneOutScore(
      samples, rig_.camera, result.averaged.T_camera_lidar, rig_.extrinsic_refiner);
  result.in_sample = ScoreScene(samples, rig_.camera, result.T_camera_lidar);
  result.of_average = ScoreScene(samples, rig_.camera, result.averaged.T_camera_lidar);

  result.used_ids = IdsOf(samples);
  for (std::size_t i = 0; i < averaged_->inconsistent_ids.size(); ++i) {
    result.rejected.push_back({averaged_->inconsistent_ids[i], averaged_->inconsistent_reasons[i]});
  }
  result.made_from = {samples_->log_sha256, rig_.sha256, VOQCAL_VERSION};
  return result;
}

}  // namespace voqcal
