#include "core/lens_calibration/lens_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/camera/image_parts.hpp"
#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kTiltedRad = 15 * kRadPerDeg;
constexpr int kMinTilted = 3;
constexpr double kPoorSigma = 0.002;  // of the focal length: worth a warning

LensCoverage CoverageOf(const LensFit& fit, const std::vector<LensView>& views) {
  LensCoverage coverage;
  for (const LensView& view : views) {
    for (const Eigen::Vector2d& corner_px : view.corners_px) {
      if (!corner_px.allFinite()) continue;
      ++coverage.num_corners[ImagePartAt(corner_px, fit.camera)];
    }
  }
  coverage.least_tilt_rad = M_PI;
  for (const Eigen::Isometry3d& T_camera_board : fit.T_camera_board) {
    const Eigen::Vector3d normal_camera = T_camera_board.linear().col(2);
    const double tilt_rad = std::acos(std::clamp(-normal_camera.z(), -1.0, 1.0));
    coverage.least_tilt_rad = std::min(coverage.least_tilt_rad, tilt_rad);
    coverage.most_tilt_rad = std::max(coverage.most_tilt_rad, tilt_rad);
    if (tilt_rad < kTiltedRad) continue;
    const bool is_sideways = std::abs(normal_camera.x()) > std::abs(normal_camera.y());
    const bool is_less = (is_sideways ? normal_camera.x() : normal_camera.y()) < 0;
    ++coverage.num_tilted[(is_sideways ? 0U : 2U) + (is_less ? 0U : 1U)];
  }
  return coverage;
}

int NumTilted(const LensCoverage& coverage) {
  return std::accumulate(coverage.num_tilted.begin(), coverage.num_tilted.end(), 0);
}

bool LacksTilt(const LensCoverage& coverage) { return NumTilted(coverage) < kMinTilted; }

std::string HowToTilt(const LensCoverage& coverage) {
  if (!LacksTilt(coverage)) return "take more poses, near ones that fill the image";
  return Format(
      "%d of the poses are tilted by 15 degrees or more: tilt the board by 20 to 45 degrees "
      "to the left, right, up and down",
      NumTilted(coverage));
}

double ShiftSigma(const LensFit& fit) {
  return fit.shift_sigma_px / std::min(fit.camera.fx_px, fit.camera.fy_px);
}

bool HasSquarePixels(const CameraModel& camera) {
  return std::abs(camera.fx_px / camera.fy_px - 1) < 0.1;
}

bool CouldBeACamera(const CameraModel& camera) {
  const auto is_near_middle = [](double centre_px, double size_px) {
    return centre_px > 0.2 * size_px && centre_px < 0.8 * size_px;
  };
  return HasSquarePixels(camera) && is_near_middle(camera.cx_px, camera.width_px) &&
         is_near_middle(camera.cy_px, camera.height_px);
}

std::string HowToBeACamera(const CameraModel& camera, const LensCoverage& coverage) {
  if (LacksTilt(coverage)) return HowToTilt(coverage);
  const char* const what =
      HasSquarePixels(camera) ? "cut on one side" : "squeezed to another shape";
  return std::string("if the images were ") + what +
         ", give them as the camera takes them, or cut or scaled alike on all sides; else " +
         HowToTilt(coverage);
}

std::string RefusalOf(const LensCalibrationOptions& options, const LensCalibration& result) {
  if (result.views.size() < options.min_views) {
    std::string text = Format("%zu images of different poses can be used, %zu are needed",
                              result.views.size(),
                              options.min_views);
    if (!result.odd.empty()) text += Format(" (%zu contradict the others)", result.odd.size());
    return text;
  }
  if (!result.best) return "no lens of the model explains the corners";
  const LensFit& fit = result.best->fit;
  const LensCoverage& coverage = result.coverage;
  if (!(fit.rms_px <= options.max_rms_px)) {
    return Format("the RMS is %.2f px, at most %.2f: another lens model, or the board is not flat",
                  fit.rms_px,
                  options.max_rms_px);
  }
  if (!(fit.scale_sigma <= options.max_sigma)) {
    return Format(
               "the focal length is not determined (1 sigma %.2g %% where the boards were, at "
               "most %.2g %%): ",
               100 * fit.scale_sigma,
               100 * options.max_sigma) +
           HowToTilt(coverage);
  }
  if (!(ShiftSigma(fit) <= options.max_sigma)) {
    return Format(
               "the principal point is not determined (1 sigma %.2g px where the boards were, "
               "at most %.2g): ",
               fit.shift_sigma_px,
               options.max_sigma * std::min(fit.camera.fx_px, fit.camera.fy_px)) +
           HowToTilt(coverage);
  }
  if (!std::isfinite(result.best->held_out.rms_px)) {
    return "without some of the poses the lens is not determined: take more";
  }
  if (!CouldBeACamera(fit.camera)) {
    return Format("fx %.5g, fy %.5g, principal point (%.5g, %.5g) are no camera's: ",
                  fit.camera.fx_px,
                  fit.camera.fy_px,
                  fit.camera.cx_px,
                  fit.camera.cy_px) +
           HowToBeACamera(fit.camera, coverage);
  }
  return "";
}

std::vector<std::string> AdviceOf(const LensCalibration& result) {
  static const char* const kSides[] = {"left", "right", "up", "down"};
  std::vector<std::string> advice;
  std::string parts;
  for (std::size_t i = 0; i < kNumImageParts; ++i) {
    if (result.coverage.num_corners[i] == 0) {
      parts += (parts.empty() ? "" : ", ") + ImagePartNames()[i];
    }
  }
  if (!parts.empty()) {
    advice.push_back("no corner was seen in these parts of the image: " + parts +
                     ": show the board there; the lens is extrapolated");
  }
  const double sigma = result.best->fit.scale_sigma;
  if (sigma > kPoorSigma) {
    advice.push_back(
        Format("the focal length is not well determined (1 sigma %.2g %%): ", 100 * sigma) +
        HowToTilt(result.coverage));
  } else if (LacksTilt(result.coverage)) {
    advice.push_back(HowToTilt(result.coverage));
  }
  std::string sides;
  for (std::size_t i = 0; i < 4; ++i) {
    if (result.coverage.num_tilted[i] == 0) {
      sides += (sides.empty() ? "" : ", ") + std::string(kSides[i]);
    }
  }
  if (!sides.empty() && !LacksTilt(result.coverage)) {
    advice.push_back("the board was never turned " + sides + ": turn it so");
  }
  return advice;
}

}  // namespace

void JudgeLens(const LensCalibrationOptions& options, LensCalibration* result) {
  if (result->best) {
    result->coverage = CoverageOf(result->best->fit, result->views);
    result->advice = AdviceOf(*result);
  }
  result->refusal = RefusalOf(options, *result);
}

}  // namespace voqcal
