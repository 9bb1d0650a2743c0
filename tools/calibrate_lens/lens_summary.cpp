#include "calibrate_lens/lens_summary.hpp"

#include <cmath>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::string ParameterLines(const LensFit& fit) {
  static const char* const kPixelNames[] = {"fx_px", "fy_px", "cx_px", "cy_px"};
  const CameraModel& camera = fit.camera;
  const double pixels[] = {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
  std::string text;
  for (int i = 0; i < 4; ++i) {
    text += Format("  %-14s %10.3f +- %.3f px", kPixelNames[i], pixels[i], fit.Sigma(i));
    if (i < 2) text += Format("  (%.2g %%)", 100 * fit.Sigma(i) / pixels[i]);
    text += '\n';
  }
  for (int i = 0; i < fit.form.num_free; ++i) {
    text += Format("  distortion[%d]  %10.6f +- %.6f\n",
                   i,
                   camera.distortion[static_cast<std::size_t>(i)],
                   fit.Sigma(4 + i));
  }
  return text;
}

std::string TrialLines(const LensCalibration& calibration) {
  if (calibration.trials.size() < 2) return "";
  std::string text = "models      simplest first; taken: the first as good as the best\n";
  for (const LensTrial& trial : calibration.trials) {
    text +=
        Format("  %-32s RMS %.3f px, held out %.3f px%s\n",
               ToString(trial.fit.form).c_str(),
               trial.fit.rms_px,
               trial.held_out.rms_px,
               ToString(trial.fit.form) == ToString(calibration.best->fit.form) ? "  taken" : "");
  }
  return text;
}

std::string CoverageLines(const LensCoverage& coverage) {
  std::string text = "corners     by part of the image\n";
  for (std::size_t row = 0; row < 3; ++row) {
    text += "  ";
    for (std::size_t column = 0; column < 3; ++column) {
      text += Format("%7d", coverage.num_corners[3 * row + column]);
    }
    text += '\n';
  }
  const auto& tilted = coverage.num_tilted;
  return text + Format(
                    "tilt        %.0f to %.0f deg; by 15 and more to the left %d, right %d, up %d, "
                    "down %d\n",
                    coverage.least_tilt_rad * kDegPerRad,
                    coverage.most_tilt_rad * kDegPerRad,
                    tilted[0],
                    tilted[1],
                    tilted[2],
                    tilted[3]);
}

}  // namespace

CameraModel Rounded(const CameraModel& camera) {
  CameraModel rounded = camera;
  for (double* pixels : {&rounded.fx_px, &rounded.fy_px, &rounded.cx_px, &rounded.cy_px}) {
    *pixels = std::round(*pixels * 1e3) / 1e3;
  }
  for (double& coefficient : rounded.distortion) coefficient = std::round(coefficient * 1e7) / 1e7;
  return rounded;
}

std::string LensSummary(const LensCalibration& calibration,
                        const BoardSpec& board,
                        const std::optional<CameraModel>& given) {
  std::string text;
  for (std::size_t i = 0; i < calibration.odd.size(); ++i) {
    text += Format("left out    the image at %.3f s contradicts the others: ",
                   1e-6 * static_cast<double>(calibration.odd[i].utime));
    text += std::isfinite(calibration.odd_rms_px[i])
                ? Format("RMS %.2f px\n", calibration.odd_rms_px[i])
                : "no pose explains it\n";
  }
  if (!calibration.best) return text;
  const LensTrial& best = *calibration.best;
  text += TrialLines(calibration);
  text += Format("lens        %s, by %zu images: RMS %.3f px, held out %.3f px\n",
                 ToString(best.fit.form).c_str(),
                 calibration.views.size(),
                 best.fit.rms_px,
                 best.held_out.rms_px);
  text += ParameterLines(best.fit);
  text += Format("  where the boards were: scale +- %.2g %%, shift +- %.2g px\n",
                 100 * best.fit.scale_sigma,
                 best.fit.shift_sigma_px);
  if (given) {
    const HeldOutErrors errors = ErrorsOfLens(*given, board, calibration.views);
    text += Format("rig file    its intrinsics (%s, fx %.3f) on these images: ",
                   ToString(given->lens).c_str(),
                   given->fx_px);
    text += std::isfinite(errors.rms_px) ? Format("RMS %.3f px\n", errors.rms_px)
                                         : "no pose explains some of them\n";
  }
  text += CoverageLines(calibration.coverage);
  for (const std::string& advice : calibration.advice) text += "better      " + advice + '\n';
  return text;
}

}  // namespace voqcal
