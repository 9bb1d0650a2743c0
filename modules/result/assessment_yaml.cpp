#include "result/assessment_yaml.hpp"

#include <cmath>

#include "core/units.hpp"
#include "files/number_text.hpp"
#include "files/transform_yaml.hpp"

namespace voqcal {
namespace {

std::string SpreadLine(const std::string& name, const Spread& spread) {
  return "    " + name + ": {mean: " + NumberText(spread.mean) +
         ", std: " + NumberText(spread.std) + ", max: " + NumberText(spread.max) + "}\n";
}

std::string Number(const std::string& key, double value) {
  return std::isnan(value) ? "" : "    " + key + ": " + NumberText(value) + "\n";
}

std::string SceneAxisYaml(const SceneCheck& check) {
  const char* const names[] = {
      "turn_x_deg", "turn_y_deg", "turn_z_deg", "shift_x_mm", "shift_y_mm", "shift_z_mm"};
  std::string text;
  for (int i = 0; i < 6; ++i) {
    const double unit = i < 3 ? kDegPerRad : 1e3;
    text += std::string("  ") + names[i] + ": {asked: " + NumberText(unit * check.asked[i]) +
            ", standard_error: " + NumberText(unit * check.sigma[i]) +
            ", verdict: " + QuotedYaml(ToString(check.axes[static_cast<std::size_t>(i)])) + "}\n";
  }
  return text;
}

}  // namespace

std::string QuotedYaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20;
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += is_control ? ' ' : c;
  }
  return quoted + '"';
}

std::string ScoreYaml(const SceneScore& score) {
  return SpreadLine("centre_px", score.centre_px) + SpreadLine("centre_mm", score.centre_mm) +
         SpreadLine("corner_mm", score.corner_mm) + SpreadLine("normal_deg", score.normal_deg);
}

std::string BinsYaml(const std::string& name, const std::vector<ScoreBin>& bins) {
  std::string text = "  " + name + ":" + (bins.empty() ? " []" : "") + "\n";
  for (const ScoreBin& bin : bins) {
    text += "    - {where: " + QuotedYaml(bin.name) +
            ", samples: " + std::to_string(bin.score.poses.size()) +
            ", centre_px: " + NumberText(bin.score.centre_px.mean) +
            ", centre_mm: " + NumberText(bin.score.centre_mm.mean) +
            ", corner_mm: " + NumberText(bin.score.corner_mm.mean) +
            ", normal_deg: " + NumberText(bin.score.normal_deg.mean) + "}\n";
  }
  return text;
}

std::string PredictedYaml(const std::vector<PredictedError>& predicted) {
  std::string text =
      "# RMS error of a lidar point in the image, by covariance_given_rig: in the image's\n"
      "# middle, and in the worst of its corners\n"
      "predicted_errors:" +
      std::string(predicted.empty() ? " []" : "") + "\n";
  for (const PredictedError& error : predicted) {
    text += "  - {range_m: " + NumberText(error.range_m) +
            ", centre_px: " + NumberText(error.centre_px) +
            ", centre_mm: " + NumberText(error.centre_mm) +
            ", corner_px: " + NumberText(error.corner_px) +
            ", corner_mm: " + NumberText(error.corner_mm) + "}\n";
  }
  return text;
}

std::string SceneCheckYaml(const SceneCheck& check) {
  std::string text =
      "# do the background's depth edges lie on edges of the images? No target is needed for it.\n"
      "scene_check:\n  verdict: " +
      QuotedYaml(ToString(check.verdict)) + "\n  reason: " + QuotedYaml(check.reason) +
      "\n  num_scenes: " + std::to_string(check.num_scenes) +
      "\n  num_edges: " + std::to_string(check.num_edges) + "\n";
  if (check.probes.empty()) return text;
  text +=
      "  # mean rank of the image gradient under the edges: 0.5 is chance\n  score: {refined: " +
      NumberText(check.score) + ", asked: " + NumberText(check.asked_score) +
      "}\n  # what the edges ask for, along and about the camera's axes\n" + SceneAxisYaml(check) +
      "  perturbed:  # delta: rotation_rad, then translation_m, left (camera) side\n";
  for (const SceneProbe& probe : check.probes) {
    text +=
        "    - {delta: " + ListYaml(probe.delta) + ", score: " + NumberText(probe.score) + "}\n";
  }
  return text;
}

std::string DiagnosisYaml(const Diagnosis& diagnosis) {
  std::string text = "diagnosis:  # what is likely wrong, most likely first; none: nothing found" +
                     std::string(diagnosis.findings.empty() ? "\n  []" : "") + "\n";
  for (const Finding& finding : diagnosis.findings) {
    text += "  - cause: " + QuotedYaml(finding.cause) + "\n    text: " + QuotedYaml(finding.text) +
            "\n" + Number("value", finding.value) +
            Number("standard_error", finding.standard_error) +
            (finding.unit.empty() ? "" : "    unit: " + QuotedYaml(finding.unit) + "\n") +
            Number("log_likelihood_gain", finding.log_likelihood_gain) +
            Number("explained", finding.explained) +
            Number("held_out_before_mm", finding.held_out_before_mm) +
            Number("held_out_after_mm", finding.held_out_after_mm);
  }
  text += "not_judged:" + std::string(diagnosis.not_judged.empty() ? " []" : "") + "\n";
  for (const std::string& each : diagnosis.not_judged) text += "  - " + QuotedYaml(each) + "\n";
  return text;
}

}  // namespace voqcal
