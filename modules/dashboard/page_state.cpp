#include "dashboard/page_state.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "core/selection/voq.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "core/units.hpp"
#include "dashboard/slot.hpp"
#include "messaging/convert_board.hpp"
#include "result/extrinsic_text.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::json;

Json Of(Slot slot) { return {{"kind", ToString(slot)}}; }

// Text of a message may be in any encoding; JSON is UTF-8.
std::string Text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Vector>
Json List(const Vector& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

Json Corners(const BoardPose& pose) {
  Json array = Json::array();
  for (const Eigen::Vector3d& corner : pose.corners_m) array.push_back(List(corner));
  return array;
}

/// Where the camera sees the outline; null where a corner is behind it.
Json Outline(const BoardPose& pose_camera, const CameraModel& camera) {
  Json array = Json::array();
  for (const Eigen::Vector3d& corner : pose_camera.corners_m) {
    if (!corner.allFinite() || !camera.IsInFront(corner)) return nullptr;
    array.push_back(List(Eigen::Vector2d(camera.Project(corner))));
  }
  return array;
}

/// Directions of sight round the image's border, some of each side, its corner first; none if the
/// lens model does not reach so far.
Json Border(const CameraModel& camera) {
  constexpr int kNumOfSide = 6;
  const double right = camera.width_px - 1;
  const double bottom = camera.height_px - 1;
  const std::array<Eigen::Vector2d, 4> corners = {
      {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}}};
  Json array = Json::array();
  for (std::size_t side = 0; side < corners.size(); ++side) {
    for (int i = 0; i < kNumOfSide; ++i) {
      const Eigen::Vector2d step =
          (corners[(side + 1) % corners.size()] - corners[side]) / kNumOfSide;
      const auto ray = camera.Unproject(corners[side] + i * step);
      if (!ray) return Json::array();
      array.push_back(List(*ray));
    }
  }
  return array;
}

template <std::size_t kRows, std::size_t kColumns>
Json Table(const double (&values)[kRows][kColumns]) {
  Json array = Json::array();
  for (const auto& row : values) array.push_back(List(row));
  return array;
}

/// What became of each sample.
struct Fates {
  std::map<std::int64_t, std::string> left_out;  ///< And why.
  std::map<std::int64_t, double> held_out_mm;    ///< Of those that were used.
};

Fates FatesOf(const extrinsic_averaged_t* averaged, const assessment_t* assessment) {
  Fates fates;
  if (averaged != nullptr) {
    for (std::size_t i = 0; i < averaged->inconsistent_ids.size(); ++i) {
      fates.left_out[averaged->inconsistent_ids[i]] = averaged->inconsistent_reasons[i];
    }
  }
  if (assessment != nullptr) {
    for (std::size_t i = 0; i < assessment->sample_ids.size(); ++i) {
      fates.held_out_mm[assessment->sample_ids[i]] = assessment->held_out_centre_mm[i];
    }
  }
  return fates;
}

Json SamplePart(const BoardSample& sample, const Fates& fates, const Rig& rig) {
  const Eigen::Vector3d& normal = sample.camera.pose.normal;
  Json part = {{"id", sample.id},
               {"num_frames", sample.num_frames},
               {"distance_m", sample.camera.pose.centre_m.norm()},
               {"e_dim_mm", BoardDimensionErrorMm(sample.lidar.edge_lengths_m, rig.board)},
               // Which way the board faces, seen by the camera: to the right, and up.
               {"faces_right_deg", kDegPerRad * std::atan2(normal.x(), -normal.z())},
               {"faces_up_deg", kDegPerRad * std::atan2(-normal.y(), -normal.z())},
               {"corners_lidar_m", Corners(sample.lidar.pose)},
               {"outline_px", Outline(sample.camera.pose, rig.camera)},
               {"warnings", Json::array()}};
  for (const SightingWarning& warning : sample.camera.warnings) {
    part["warnings"].push_back(warning.reason + ": " + warning.detail);
  }
  const auto left_out = fates.left_out.find(sample.id);
  const auto held_out = fates.held_out_mm.find(sample.id);
  if (left_out != fates.left_out.end()) part["left_out"] = left_out->second;
  if (held_out != fates.held_out_mm.end()) part["held_out_mm"] = held_out->second;
  return part;
}

Json Part(const spread_t& spread) {
  return {{"mean", spread.mean}, {"std", spread.std}, {"max", spread.max}};
}

/// Of a pair's assessment or of a rig.
template <typename Message>
Json VerdictPart(const Message& message) {
  Json checks = Json::array();
  for (const verdict_check_t& check : message.verdict_checks) {
    checks.push_back({{"name", check.name}, {"grade", check.grade}, {"text", check.text}});
  }
  return {
      {"grade", message.verdict_grade}, {"headline", message.verdict_headline}, {"checks", checks}};
}

Json RowPart(const PairRow& row) {
  Json part = {{"name", row.name},
               {"lidar", row.lidar},
               {"camera", row.camera},
               {"num_samples", row.num_samples},
               {"silent", row.silent},
               {"unheard", row.unheard},
               {"is_current", row.is_current},
               {"problem", row.result == nullptr ? "" : row.result->problem},
               {"grade", row.result == nullptr ? "" : row.result->verdict_grade},
               {"headline", row.result == nullptr ? "" : row.result->verdict_headline}};
  if (row.next_pose != nullptr) {
    part["worst_error"] = row.next_pose->worst_error;
    part["unit"] = row.next_pose->unit;
    part["is_enough"] = row.next_pose->is_enough != 0;
  }
  return part;
}

/// 1 sigma of three of a covariance's axes.
Json Sigma(const double (&covariance)[6][6], int first, double scale) {
  Json sigma = Json::array();
  for (int i = first; i < first + 3; ++i) sigma.push_back(scale * std::sqrt(covariance[i][i]));
  return sigma;
}

}  // namespace

std::string RigJson(const Rig& rig, bool is_of_several) {
  Json json = Of(Slot::kRig);
  json["name"] = is_of_several ? rig.rig_name : rig.name;
  if (is_of_several) {
    json["pair"] = {{"name", PairName(rig.lidar_name, rig.camera_name)},
                    {"lidar", rig.lidar_name},
                    {"camera", rig.camera_name}};
  }
  json["camera"] = {{"width_px", rig.camera.width_px},
                    {"height_px", rig.camera.height_px},
                    {"border", Border(rig.camera)}};
  return Text(json);
}

// A rig has enough once its weakest pair has, whether or not that can be sampled now.
std::string PairsJson(const std::vector<PairRow>& rows,
                      const rig_extrinsics_t* rig,
                      const std::string& next) {
  Json json = Of(Slot::kPairs);
  json["pairs"] = Json::array();
  json["is_enough"] = false;
  json["is_current"] = true;
  for (const PairRow& row : rows) {
    json["pairs"].push_back(RowPart(row));
    if (!row.is_current) json["is_current"] = false;
    const bool is_weakest = rig != nullptr && row.name == rig->weakest_pair;
    if (is_weakest && row.next_pose != nullptr) json["is_enough"] = row.next_pose->is_enough != 0;
  }
  json["next"] = next;
  json["problem"] = rig == nullptr ? "" : rig->problem;
  if (rig != nullptr && !rig->verdict_grade.empty()) json["verdict"] = VerdictPart(*rig);
  return Text(json);
}

std::string SamplesJson(const samples_t& message,
                        const std::vector<BoardSample>& samples,
                        const extrinsic_averaged_t* averaged,
                        const assessment_t* assessment,
                        const Rig& rig) {
  const Fates fates = FatesOf(averaged, assessment);
  Json json = Of(Slot::kSamples);
  json["revision"] = message.revision;
  json["is_finished"] = message.is_finished != 0;
  json["samples"] = Json::array();
  for (const BoardSample& sample : samples)
    json["samples"].push_back(SamplePart(sample, fates, rig));
  return Text(json);
}

std::string ResultJson(const extrinsic_refined_t& refined,
                       const assessment_t& assessment,
                       bool is_current,
                       const std::string& working_on,
                       const std::vector<std::string>& exports) {
  Json json = Of(Slot::kResult);
  json["working_on"] = working_on;
  json["is_current"] = is_current;
  json["method"] = refined.method;
  json["num_samples"] = refined.num_samples;
  json["translation_m"] = List(refined.T_camera_lidar.translation_m);
  json["quaternion_xyzw"] = List(refined.T_camera_lidar.quaternion_xyzw);
  json["sigma_deg"] = Sigma(refined.covariance_given_rig, 0, kDegPerRad);
  json["sigma_mm"] = Sigma(refined.covariance_given_rig, 3, kMmPerM);
  json["place_sigma_deg"] = Sigma(refined.covariance, 0, kDegPerRad);
  json["place_sigma_mm"] = Sigma(refined.covariance, 3, kMmPerM);
  json["held_out"] = {{"centre_px", Part(assessment.refined_held_out.centre_px)},
                      {"centre_mm", Part(assessment.refined_held_out.centre_mm)}};
  json["predicted"] = Json::array();
  for (const predicted_error_t& each : assessment.predicted) {
    json["predicted"].push_back({{"range_m", each.range_m}, {"corner_mm", each.corner_mm}});
  }
  json["verdict"] = VerdictPart(assessment);
  json["exports"] = exports;
  return Text(json);
}

std::string NoResultJson(const std::string& problem, const std::string& working_on) {
  Json json = Of(Slot::kResult);
  json["problem"] = problem;
  json["working_on"] = working_on;
  return Text(json);
}

std::string ReportJson(const SessionReport& report, const std::string& folder) {
  Json json = Of(Slot::kReport);
  json["state"] = report.state;
  json["file"] = report.file;
  json["folder"] = folder;
  return Text(json);
}

// "beat" is new each second, so that a page knows that it is still told.
std::string ModulesJson(const RigHealth& health,
                        const Channels& channels,
                        RigHealth::Time now,
                        const std::set<std::string>& names_of_others) {
  Json json = Of(Slot::kModules);
  json["beat"] = std::chrono::floor<std::chrono::seconds>(now.time_since_epoch()).count();
  json["modules"] = Json::array();
  for (const auto& [name, heard] : health.heartbeats().heard()) {
    json["modules"].push_back({{"name", name},
                               {"state", heard.status.state},
                               {"health", ToString(health.HealthOf(name, now))}});
  }
  json["faults"] = Json::array();
  for (const Fault& fault : health.Faults(now)) {
    json["faults"].push_back({{"of", fault.of},
                              {"what", fault.what},
                              {"cause", fault.cause},
                              {"remedy", fault.remedy},
                              {"is_grave", fault.is_grave}});
    if (names_of_others.count(fault.of) != 0) json["faults"].back()["is_of_others"] = true;
  }
  json["flows"] = {{"lidar", ToString(health.FlowOf(channels.lidar_points, now))},
                   {"camera", ToString(health.FlowOf(channels.camera_image, now))},
                   {"lidar_board", ToString(health.FlowOf(channels.lidar_board, now))},
                   {"camera_board", ToString(health.FlowOf(channels.camera_board, now))}};
  return Text(json);
}

std::string LidarBoardJson(const lidar_board_t& message) {
  Json json = Of(Slot::kLidarBoard);
  json["utime"] = message.utime;
  json["miss"] = message.miss;
  if (message.miss.empty() && !message.candidates.empty()) {
    json["corners_lidar_m"] = Table(message.candidates[0].pose.corners_m);
    json["num_points"] = message.candidates[0].num_points;
  }
  return Text(json);
}

std::string CameraBoardJson(const camera_board_t& message, const CameraModel& camera) {
  Json json = Of(Slot::kCameraBoard);
  json["utime"] = message.utime;
  json["miss"] = message.miss;
  json["detail"] = message.detail;
  if (!message.miss.empty()) return Text(json);
  const CameraBoard board = FromMessage(message);
  json["outline_px"] = Outline(board.pose, camera);
  json["corners_px"] = Json::array();
  for (const Eigen::Vector2d& corner : board.corners_px) {
    if (corner.allFinite()) json["corners_px"].push_back(List(corner));
  }
  json["warnings"] = Json::array();
  for (const warning_t& warning : message.warnings) json["warnings"].push_back(warning.reason);
  return Text(json);
}

std::string GuidanceJson(const next_pose_t& message, const Order& order) {
  Json json = Of(Slot::kGuidance);
  json["problem"] = message.problem;
  json["advice"] = order.words;
  json["away_m"] = order.away_m;
  json["unit"] = message.unit;
  json["tolerance"] = message.tolerance;
  json["min_range_m"] = message.min_range_m;
  json["max_range_m"] = message.max_range_m;
  json["min_samples"] = message.min_samples;
  json["worst_error"] = message.worst_error;
  json["predicted_worst_error"] = message.predicted_worst_error;
  json["is_enough"] = message.is_enough != 0;
  if (!message.problem.empty()) return Text(json);
  json["corners_px"] = Table(message.corners_px);
  if (message.is_lidar_known != 0) json["corners_lidar_m"] = Table(message.corners_lidar_m);
  return Text(json);
}

std::string EventsJson(const std::deque<CountedEvent>& events) {
  Json json = Of(Slot::kEvents);
  json["events"] = Json::array();
  for (const CountedEvent& each : events) {
    json["events"].push_back({{"seq", each.event.seq},
                              {"event", each.event.kind},
                              {"sample_id", each.event.sample_id},
                              {"reason", each.event.reason},
                              {"count", each.count}});
  }
  return Text(json);
}

}  // namespace voqcal
