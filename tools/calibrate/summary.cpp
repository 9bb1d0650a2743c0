#include "calibrate/summary.hpp"

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::string Tenths(double value) { return std::isnan(value) ? "-" : Format("%.1f", value); }

// "  1 sigma of what  0.3 0.6 0.4 mm, 0.012 0.010 0.004 deg"; "unknown" where nothing tells.
std::string SigmaLine(const std::string& of_what, const Matrix6d& covariance) {
  const std::string line = "  1 sigma " + of_what + "  ";
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  if (!sigma.allFinite()) return line + "unknown\n";
  const Eigen::Vector3d mm = kMmPerM * sigma.tail<3>();
  const Eigen::Vector3d deg = kDegPerRad * sigma.head<3>();
  return line + Format("%.1f %.1f %.1f mm, %.3f %.3f %.3f deg\n",
                       mm.x(),
                       mm.y(),
                       mm.z(),
                       deg.x(),
                       deg.y(),
                       deg.z());
}

/// The headline, then what is not good.
std::string VerdictLines(const Verdict& verdict) {
  std::string text = "verdict  " + verdict.headline + "\n";
  for (const VerdictCheck& check : verdict.checks) {
    if (check.grade != Grade::kGood) text += "  " + check.name + ": " + check.text + "\n";
  }
  return text;
}

std::string TransformLines(const CalibrationResult& result) {
  const Eigen::Vector3d& t = result.T_camera_lidar.translation();
  Eigen::Quaterniond q(result.T_camera_lidar.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return Format(
             "T_camera_lidar (p_camera = T_camera_lidar * p_lidar)\n"
             "  translation_m    %9.5f %9.5f %9.5f\n"
             "  quaternion_xyzw  %9.6f %9.6f %9.6f %9.6f\n",
             t.x(),
             t.y(),
             t.z(),
             q.x(),
             q.y(),
             q.z(),
             q.w()) +
         SigmaLine("in this camera's image (the rig file taken as exact)",
                   result.covariance_given_rig) +
         SigmaLine("of the lidar's place (the rig file's camera and board may be off)",
                   result.covariance);
}

// The average is not held out: its own samples flatter it.
std::string TrialText(const MethodTrial& trial) {
  if (std::isnan(trial.ErrorMm())) return " unknown";
  const bool is_own = trial.method == RefineMethod::kAverage;
  return Format(" %.2f mm", trial.ErrorMm()) + (is_own ? " on its own" : "");
}

std::string MethodLines(const CalibrationResult& result) {
  std::string text =
      "method  " + ToString(result.method) + " (error on poses held out, of centre and corners:";
  for (const MethodTrial& trial : result.trials) {
    text += (&trial == &result.trials[0] ? " " : ", ") + ToString(trial.method) +
            (trial.problem.empty() ? TrialText(trial) : ": " + trial.problem);
  }
  text += ")\n";
  if (!result.scene_note.empty()) text += "scene   " + result.scene_note + "\n";
  constexpr double kLeastDeg = 0.05;
  const Eigen::Vector2d turn_deg = kDegPerRad * result.chessboard_turn.value_rad;
  const Eigen::Vector2d sigma_deg = kDegPerRad * result.chessboard_turn.standard_error_rad;
  if (turn_deg.norm() > kLeastDeg) {
    text += Format(
        "chessboards  turned by %+.2f +- %.2f and %+.2f +- %.2f deg about the camera's x and y "
        "against the rays to them, as by a principal point or scan lines that are off: taken out\n",
        turn_deg.x(),
        sigma_deg.x(),
        turn_deg.y(),
        sigma_deg.y());
  }
  if (!result.lidar_bias.IsObservable()) return text + "lidar's range errors  not estimated\n";
  text += "lidar's range errors  common " + result.lidar_bias.common.Text() +
          ", dark against bright " + result.lidar_bias.dark_step.Text();
  if (result.lidar_bias.rings.size() < 2) return text + "\n";  // a cloud without ring numbers
  double lowest_m = 0.0;
  double highest_m = 0.0;
  for (const BiasEstimate& ring : result.lidar_bias.rings) {
    lowest_m = std::min(lowest_m, ring.value_m);
    highest_m = std::max(highest_m, ring.value_m);
  }
  return text + Format(", rings %+.1f to %+.1f mm\n", 1e3 * lowest_m, 1e3 * highest_m);
}

std::string LensLines(const CalibrationResult& result) {
  const LensCorrection& lens = result.lens_correction;
  if (!lens.IsUsable()) return "lens  no correction: " + lens.problem + "\n";
  const LensErrors px = LensReachPx(lens.camera) * lens.errors.errors;
  return "lens  held out with the intrinsics corrected by the same samples: " +
         Summary(lens.held_out) + "\n" +
         Format(
             "  focal length %+.2f %%, principal point %+.1f %+.1f px, radial %+.1f %+.1f px at "
             "half the width\n  ",
             100 * lens.errors.errors[kFocalLength],
             px[kPrincipalPointX],
             px[kPrincipalPointY],
             px[kRadial2],
             px[kRadial4]) +
         WhichToTake(lens, result.T_camera_lidar) + "\n";
}

std::string SceneLines(const CalibrationResult& result) {
  std::string text = "by part of the scene, held-out centres\n";
  for (const auto* bins : {&result.held_out_by_cell, &result.held_out_by_range}) {
    std::string line;
    for (const ScoreBin& bin : *bins) {
      line += (line.empty() ? "  " : "; ") + bin.name + " " + Tenths(bin.score.centre_mm.mean) +
              Format(" mm (%zu)", bin.score.poses.size());
    }
    text += line + "\n";
  }
  const bool has_open_corner = std::any_of(
      result.predicted.begin(), result.predicted.end(), [](const PredictedError& error) {
        return std::isnan(error.corner_px);
      });
  text += std::string("predicted, 1 sigma in this camera's image, its middle (worst corner") +
          (has_open_corner ? "; -: the lens model has no ray there" : "") + ")\n ";
  for (const PredictedError& error : result.predicted) {
    text += Format(" %.0f m: ", error.range_m) + Tenths(error.centre_px) + " px (" +
            Tenths(error.corner_px) + ");";
  }
  text.back() = '\n';
  const SceneCheck& check = result.scene_check;
  text += "scene check, without the board\n  " + ToString(check.verdict);
  if (!check.probes.empty()) {
    text += Format(": score %.3f, of what it asks for %.3f", check.score, check.asked_score);
  }
  return text + "; " + check.reason + "\n";
}

std::string DiagnosisLines(const CalibrationResult& result) {
  const Diagnosis& diagnosis = result.diagnosis;
  std::string text = "what is likely wrong\n";
  if (diagnosis.findings.empty()) {
    text += result.lens_correction.IsUsable()
                ? "  nothing but the lens, above, would explain the errors better\n"
                : "  nothing that would explain the errors better\n";
  }
  for (const Finding& finding : diagnosis.findings) {
    text += "  " + finding.cause + ": " + finding.text + "\n";
  }
  for (const std::string& each : diagnosis.not_judged) text += "  (not judged: " + each + ")\n";
  return text;
}

}  // namespace

std::string Summary(const SceneScore& score) {
  if (std::isnan(score.centre_mm.mean)) {
    return std::isnan(score.normal_deg.mean)
               ? "unknown"
               : Format("centre unknown; normals %.2f deg", score.normal_deg.mean);
  }
  return Format(
      "centre %.2f +- %.2f mm (largest %.2f), %.2f +- %.2f px; corners %.1f mm; "
      "normals %.2f deg",
      score.centre_mm.mean,
      score.centre_mm.std,
      score.centre_mm.max,
      score.centre_px.mean,
      score.centre_px.std,
      score.corner_mm.mean,
      score.normal_deg.mean);
}

std::string Summary(const CalibrationResult& result) {
  std::string text = VerdictLines(VerdictOf(result)) + TransformLines(result) + MethodLines(result);
  text += "errors over the scene, mean +- standard deviation of " +
          std::to_string(result.used_ids.size()) + " samples\n";
  text += "  held out   " + Summary(result.held_out) + "\n";
  text += "  in sample  " + Summary(result.in_sample) + "\n";
  text += "  averaged   " + Summary(result.of_average) + "   (" +
          std::to_string(result.averaged.num_kept) + " of " +
          std::to_string(result.averaged.num_sets) + " sets kept)\n";
  text += LensLines(result);
  text += "lidar's boards  sum of the edges' errors (e_dim) " + Tenths(result.e_dim_mm) +
          " mm, median of the samples\n";
  text += SceneLines(result) + DiagnosisLines(result);
  if (!result.rejected.empty()) text += "left out\n";
  for (const RejectedSample& rejected : result.rejected) {
    text += "  sample " + std::to_string(rejected.id) + ": " + rejected.reason + "\n";
  }
  for (const ExchangedSample& exchanged : result.exchanged) {
    text += "lidar's candidate " + std::to_string(exchanged.candidate + 1) + " taken\n  sample " +
            std::to_string(exchanged.id) + ": the likeliest " + exchanged.reason + "\n";
  }
  return text;
}

}  // namespace voqcal
