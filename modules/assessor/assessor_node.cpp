#include "assessor/assessor_node.hpp"

#include <utility>
#include <vector>

#include <system_error>

#include "files/atomic_file.hpp"
#include "messaging/convert_assessment.hpp"
#include "messaging/convert_board.hpp"
#include "messaging/convert_result.hpp"
#include "messaging/made_from.hpp"
#include "messaging/session_views.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

// An array of messages and its count.
template <typename Part, typename Message>
void FillArray(const std::vector<Part>& parts,
               std::vector<Message>* messages,
               std::int32_t* num_messages) {
  for (const Part& part : parts) messages->push_back(ToMessage(part));
  *num_messages = static_cast<std::int32_t>(messages->size());
}

void Fill(const CalibrationResult& result, assessment_t* assessment) {
  assessment->averaged_in_sample = ToMessage(result.of_average);
  assessment->refined_in_sample = ToMessage(result.in_sample);
  assessment->refined_held_out = ToMessage(result.held_out);
  assessment->sample_ids = result.used_ids;
  assessment->num_samples = static_cast<std::int32_t>(result.used_ids.size());
  for (const PoseScore& pose : result.held_out.poses) {
    assessment->held_out_centre_px.push_back(pose.centre_px);
    assessment->held_out_centre_mm.push_back(pose.centre_mm);
  }
  FillArray(result.held_out_by_cell, &assessment->image_cells, &assessment->num_image_cells);
  FillArray(result.held_out_by_range, &assessment->ranges, &assessment->num_ranges);
  FillArray(result.predicted, &assessment->predicted, &assessment->num_predicted);
  assessment->scene_check = ToMessage(result.scene_check);
  FillArray(result.diagnosis.findings, &assessment->findings, &assessment->num_findings);
  assessment->not_judged = result.diagnosis.not_judged;
  assessment->num_not_judged = static_cast<std::int32_t>(assessment->not_judged.size());
  const Verdict verdict = VerdictOf(result);
  assessment->verdict_grade = ToString(verdict.grade);
  assessment->verdict_headline = verdict.headline;
  FillArray(verdict.checks, &assessment->verdict_checks, &assessment->num_verdict_checks);
}

ChosenSamples ChosenOf(const samples_t& samples, const extrinsic_averaged_t& averaged) {
  ChosenSamples chosen;
  chosen.samples = SamplesAsChosen(samples, averaged.chosen);
  for (std::size_t i = 0; i < averaged.inconsistent_ids.size(); ++i) {
    chosen.rejected.push_back({averaged.inconsistent_ids[i], averaged.inconsistent_reasons[i]});
  }
  for (const chosen_candidate_t& each : averaged.chosen) {
    chosen.exchanged.push_back({each.sample_id, each.candidate, each.reason});
  }
  return chosen;
}

/// A report of an earlier result, or of none, would be taken for one of this.
void RemoveReport(const std::filesystem::path& session_folder) {
  std::error_code error;
  for (const char* name : {kReportName, kResultJsonName, kNoResultName}) {
    std::filesystem::remove(session_folder / name, error);
  }
}

/// The same result again, of an assessor that was started again, keeps its report.
void WriteResult(const std::filesystem::path& session_folder, const std::string& yaml) {
  const std::filesystem::path file = session_folder / kResultName;
  if (std::filesystem::exists(file) && ReadWholeFile(file) == yaml) return;
  RemoveReport(session_folder);
  WriteFileAtomically(file, yaml);
}

}  // namespace

AssessorNode::AssessorNode(const Rig& rig,
                           Bus* bus,
                           const std::filesystem::path& session_folder,
                           SceneViewsOf scene_views)
    : rig_(rig), bus_(*bus), session_folder_(session_folder), scene_views_(std::move(scene_views)) {
  if (!scene_views_) {
    scene_views_ = ViewsOfSession(
        rig.board, rig.camera, rig.scene_check.view, session_folder / kSamplesLogName);
  }
  std::error_code error;
  std::filesystem::create_directories(session_folder_, error);
  if (error) {
    throw std::runtime_error(session_folder_.string() +
                             ": cannot make the session's folder: " + error.message());
  }
  bus_.Keep(rig_.channels.calib_samples, &samples_);
  bus_.Keep(rig_.channels.extrinsic_averaged, &averaged_);
  bus_.Keep(rig_.channels.extrinsic_refined, &refined_);
}

std::string AssessorNode::State() const {
  if (!assessment_) return "waiting for samples and extrinsics";
  return assessment_->problem.empty() ? "running" : "waiting: " + assessment_->problem;
}

bool AssessorNode::Step() {
  if (!samples_ || !averaged_ || !refined_) return false;
  if (!IsMadeFrom(*samples_, *averaged_) || !IsMadeFrom(*samples_, *refined_)) return false;
  if (HasAssessed(*samples_)) return false;
  if (!CanRead([this] { UpdateAssessment(); })) {
    samples_.reset();
    return false;
  }
  Count(problem().empty() ? "assessments" : "without a result");
  Republish();
  return false;
}

bool AssessorNode::HasAssessed(const samples_t& samples) const {
  return assessment_ && IsMadeFrom(samples, *assessment_);
}

void AssessorNode::Republish() {
  if (assessment_) bus_.Publish(rig_.channels.calib_assessment, *assessment_);
}

void AssessorNode::UpdateAssessment() {
  assessment_t assessment{};
  StampMadeFrom(*samples_, &assessment);
  assessment.problem = refined_->problem;
  result_.reset();
  if (assessment.problem.empty()) {
    result_ = Result();
    Fill(*result_, &assessment);
    WriteResult(session_folder_, ToYaml(*result_));
  } else {
    // An earlier result is not that of these samples (after a reset, say).
    std::error_code error;
    std::filesystem::remove(session_folder_ / kResultName, error);
    RemoveReport(session_folder_);
  }
  assessment_ = std::move(assessment);
}

CalibrationResult AssessorNode::Result() {
  return {voqcal::Assess(ChosenOf(*samples_, *averaged_),
                         FromMessage(*averaged_),
                         FromMessage(*refined_),
                         scene_views_,
                         rig_.Task()),
          {samples_->log_sha256, rig_.sha256, VOQCAL_VERSION},
          rig_.camera};
}

}  // namespace voqcal
