#include "report/result_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <vector>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include "calibrate/summary.hpp"
#include "core/assessment/verdict.hpp"
#include "core/geometry/rigid.hpp"
#include "core/selection/voq.hpp"
#include "core/units.hpp"
#include "files/number_text.hpp"
#include "messaging/convert_result.hpp"
#include "report/overlays.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::ordered_json;

Json FromScalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // it was quoted
  std::int64_t whole = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
  if (error == std::errc() && end == text.data() + text.size()) return whole;
  double number = 0;
  if (ParseNumber(text, &number)) return number;
  if (text == "true" || text == "false") return text == "true";
  return text;
}

Json FromYaml(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map: {
      Json object = Json::object();
      for (const auto& entry : node) object[entry.first.Scalar()] = FromYaml(entry.second);
      return object;
    }
    case YAML::NodeType::Sequence: {
      Json array = Json::array();
      for (const YAML::Node& element : node) array.push_back(FromYaml(element));
      return array;
    }
    case YAML::NodeType::Scalar:
      return FromScalar(node);
    default:
      return nullptr;
  }
}

template <typename Vector>
Json List(const Vector& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

Json RigPart(const Rig& rig) {
  const BoardSpec& board = rig.board;
  const CameraModel& camera = rig.camera;
  const auto distortion_end = camera.distortion.begin() + NumDistortion(camera.lens);
  return {{"name", rig.name},
          {"board",
           {{"width_m", board.width_m},
            {"height_m", board.height_m},
            {"pattern", board.pattern},
            {"square_m", board.square_m},
            {"num_corners_x", board.num_corners_x},
            {"num_corners_y", board.num_corners_y}}},
          {"camera",
           {{"lens_model", ToString(camera.lens)},
            {"width_px", camera.width_px},
            {"height_px", camera.height_px},
            {"fx_px", camera.fx_px},
            {"fy_px", camera.fy_px},
            {"cx_px", camera.cx_px},
            {"cy_px", camera.cy_px},
            {"distortion", List(std::vector<double>(camera.distortion.begin(), distortion_end))}}}};
}

Json ErrorsOf(const PoseScore& score) {
  return {{"centre_px", score.centre_px},
          {"centre_mm", score.centre_mm},
          {"corner_mm", score.corner_mm},
          {"normal_deg", score.normal_deg}};
}

Json SamplePart(const BoardSample& sample, const CameraModel& camera) {
  const Eigen::Vector3d& centre_camera_m = sample.camera.pose.centre_m;
  Json part = {{"id", sample.id},
               {"utime", sample.utime},
               {"num_frames", sample.num_frames},
               {"range_m", sample.lidar.pose.centre_m.norm()},
               {"lidar_centre_m", List(sample.lidar.pose.centre_m)},
               {"lidar_normal", List(sample.lidar.pose.normal)},
               {"lidar_plane_rms_m", sample.lidar.plane_rms_m},
               {"lidar_num_points", sample.lidar.points_lidar_m.points.size()},
               {"lidar_edge_lengths_m", List(sample.lidar.edge_lengths_m)},
               {"camera_centre_m", List(centre_camera_m)},
               {"camera_normal", List(sample.camera.pose.normal)},
               {"camera_reprojection_rms_px", sample.camera.reprojection_rms_px}};
  Json sides = Json::array();
  for (const SideView side : sample.lidar.sides) sides.push_back(ToString(side));
  part["lidar_sides"] = sides;
  part["camera_centre_px"] = camera.IsInFront(centre_camera_m)
                                 ? List(camera.Project<double>(centre_camera_m))
                                 : Json(nullptr);
  return part;
}

Json SamplesPart(const Rig& rig, const OfflineRun& run) {
  const CalibrationResult& result = *run.assessor().result();
  std::map<std::int64_t, std::string> reasons;
  for (const RejectedSample& rejected : result.rejected) reasons[rejected.id] = rejected.reason;
  Json samples = Json::array();
  for (const BoardSample& sample : run.SamplesAsChosen()) {
    Json part = SamplePart(sample, rig.camera);
    const auto& used = result.used_ids;
    const auto place = std::find(used.begin(), used.end(), sample.id);
    part["is_used"] = place != used.end();
    if (place != used.end()) {
      const auto i = static_cast<std::size_t>(place - used.begin());
      part["errors"] = {{"averaged", ErrorsOf(result.of_average.poses[i])},
                        {"refined", ErrorsOf(result.in_sample.poses[i])},
                        {"held_out", ErrorsOf(result.held_out.poses[i])}};
    } else {
      part["reason"] = reasons[sample.id];
    }
    samples.push_back(part);
  }
  return samples;
}

Json SetPart(const set_extrinsic_t& set, const Eigen::Isometry3d& T_averaged) {
  const Vector6d difference = DifferenceLeft(T_averaged, FromMessage(set.T_camera_lidar));
  Json sample_ids = Json::array();
  for (const std::int64_t id : set.set.sample_ids) sample_ids.push_back(id);
  return {{"samples", sample_ids},
          {"kappa_lidar", set.set.kappa_lidar},
          {"kappa_camera", set.set.kappa_camera},
          {"e_be_mm", set.set.e_be_mm},
          {"voq", set.set.voq},
          {"status", set.status},
          {"is_kept", set.is_kept != 0},
          {"rotation_deg", List(Eigen::Vector3d(kDegPerRad * difference.head<3>()))},
          {"translation_mm", List(Eigen::Vector3d(1e3 * difference.tail<3>()))}};
}

/// The VOQ (Eq. 6, Tsai et al. 2021) of every set of three; those that are not finite are left out.
std::vector<double> VoqOfAllSets(const std::vector<const BoardSample*>& samples,
                                 const BoardSpec& board) {
  std::vector<double> errors_mm;
  for (const BoardSample* sample : samples) {
    errors_mm.push_back(BoardDimensionErrorMm(sample->lidar.edge_lengths_m, board));
  }
  std::vector<double> all;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      for (std::size_t k = j + 1; k < samples.size(); ++k) {
        const BoardSample* const set[] = {samples[i], samples[j], samples[k]};
        const double kappa_lidar = NormalConditionNumber(
            set[0]->lidar.pose.normal, set[1]->lidar.pose.normal, set[2]->lidar.pose.normal);
        const double kappa_camera = NormalConditionNumber(
            set[0]->camera.pose.normal, set[1]->camera.pose.normal, set[2]->camera.pose.normal);
        const double board_error_mm = (errors_mm[i] + errors_mm[j] + errors_mm[k]) / 3;
        const double voq = std::max(kappa_lidar, kappa_camera) + board_error_mm;
        if (std::isfinite(voq)) all.push_back(voq);
      }
    }
  }
  return all;
}

/// The VOQ of every set of consistent samples, in bins of equal width on a logarithmic axis.
Json VoqHistogram(const Rig& rig, const OfflineRun& run) {
  constexpr std::size_t kMaxSamples = 230;  // two million sets
  constexpr std::size_t kNumBins = 48;
  const std::vector<BoardSample> taken = run.SamplesAsChosen();
  const std::vector<const BoardSample*> samples =
      SamplesWithout(taken, run.averaged().inconsistent_ids);
  if (samples.size() > kMaxSamples) return nullptr;
  const std::vector<double> all = VoqOfAllSets(samples, rig.board);
  if (all.empty()) return nullptr;
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  const double low = std::log10(*least);
  const double width = std::max(std::log10(*most) - low, 1e-6) / kNumBins;
  std::vector<double> edges;
  for (std::size_t i = 0; i <= kNumBins; ++i) {
    edges.push_back(std::pow(10.0, low + width * static_cast<double>(i)));
  }
  std::vector<int> counts(kNumBins, 0);
  for (const double voq : all) {
    const auto bin = static_cast<std::size_t>((std::log10(voq) - low) / width);
    ++counts[std::min(bin, kNumBins - 1)];
  }
  return {{"num_sets", all.size()}, {"edges", edges}, {"counts", counts}};
}

Json SetsPart(const Rig& rig, const OfflineRun& run) {
  const Eigen::Isometry3d& T_averaged = run.assessor().result()->averaged.T_camera_lidar;
  Json chosen = Json::array();
  for (const set_extrinsic_t& set : run.averaged().sets) chosen.push_back(SetPart(set, T_averaged));
  return {{"chosen", chosen}, {"all_voq", VoqHistogram(rig, run)}};
}

Json FramesPart(const OfflineRun& run) {
  Json counts = Json::object();
  for (const Module* module : run.modules()) {
    if (module->counters().empty()) continue;
    counts[module->Name()] = module->counters();
  }
  Json rejected = Json::array();
  for (const event_t& event : run.events()) {
    if (event.kind != "rejected") continue;
    rejected.push_back({{"utime", event.utime}, {"reason", event.reason}});
  }
  return {{"counts", counts}, {"rejected", rejected}, {"losses", run.Losses()}};
}

/// The colours of the pictures' points at equal steps from kNearRangeM to kFarRangeM, as "#rrggbb".
Json RangeColours() {
  constexpr int kNumSteps = 16;
  Json colours = Json::array();
  for (int i = 0; i <= kNumSteps; ++i) {
    const double share = static_cast<double>(i) / kNumSteps;
    const cv::Vec3b bgr = RangeColourBgr(kNearRangeM * std::pow(kFarRangeM / kNearRangeM, share));
    char text[8];
    std::snprintf(text, sizeof(text), "#%02x%02x%02x", bgr[2], bgr[1], bgr[0]);
    colours.push_back(text);
  }
  return colours;
}

}  // namespace

std::string ResultJson(const Rig& rig, const OfflineRun& run) {
  const CalibrationResult& result = *run.assessor().result();
  const Json from_yaml = FromYaml(YAML::Load(ToYaml(result)));
  const Json json = {{"verdict", from_yaml["verdict"]},
                     {"result", from_yaml},
                     {"rig", RigPart(rig)},
                     {"samples", SamplesPart(rig, run)},
                     {"sets", SetsPart(rig, run)},
                     {"frames", FramesPart(run)},
                     {"range_colours", RangeColours()}};
  // Text of a file may be in any encoding; JSON is UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace voqcal
