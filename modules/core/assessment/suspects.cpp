#include "core/assessment/suspects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

using Say = std::function<std::string(const FaultFit& fit)>;

Suspect FocalLength(const char* cause,
                    const char* what,
                    FaultParameter fault,
                    const CameraModel& camera) {
  const Say claim = [=](const FaultFit& fit) {
    return Format("the %s given is %.2f +- %.2f %% too %s",
                  what,
                  100 * std::abs(fit.Value(fault)),
                  100 * fit.StandardError(fault),
                  fit.Value(fault) < 0 ? "long" : "short");
  };
  const Say remedy = [=](const FaultFit& fit) {
    const CameraModel mended = CameraWith(fit.Faults(), camera);
    const std::string fx = Format("camera.fx_px: %.1f", mended.fx_px);
    const std::string fy = Format("fy_px: %.1f", mended.fy_px);
    if (fault == kFocalXScale) return fx;
    return fault == kFocalYScale ? "camera." + fy : fx + ", " + fy;
  };
  constexpr double kMost = 0.2;
  return {cause, "focal length", {fault}, kMost, false, 100, "%", claim, remedy};
}

Suspect Coefficient(int i, const CameraModel& camera) {
  const auto fault = static_cast<FaultParameter>(kDistortion + i);
  const double given = camera.distortion[static_cast<std::size_t>(i)];
  const Say claim = [=](const FaultFit& fit) {
    return Format("the lens' coefficient %d is %.4f +- %.4f, not %g",
                  i + 1,
                  given + fit.Value(fault),
                  fit.StandardError(fault),
                  given);
  };
  const Say remedy = [=](const FaultFit& fit) {
    const std::string line = DistortionLine(CameraWith(fit.Faults(), camera));
    const auto& d = camera.distortion;
    const bool has_none = std::all_of(d.begin(), d.end(), [](double k) { return k == 0.0; });
    return has_none ? line + ", or better the whole lens, which calibrate_lens finds" : line;
  };
  constexpr double kMost = std::numeric_limits<double>::infinity();
  return {"distortion", "distortion", {fault}, kMost, false, 1, "", claim, remedy};
}

Suspect Squares(const BoardSpec& board) {
  const Say claim = [](const FaultFit& fit) {
    return Format("the board's squares are given %.2f +- %.2f %% too %s",
                  100 * std::abs(fit.Value(kSquareScale)),
                  100 * fit.StandardError(kSquareScale),
                  fit.Value(kSquareScale) < 0 ? "large" : "small");
  };
  const Say remedy = [board](const FaultFit& fit) {
    return SquaresLine(BoardWith(fit.Faults(), board).square_m);
  };
  constexpr double kMost = 0.3;
  return {
      "board's squares", "board's squares", {kSquareScale}, kMost, false, 100, "%", claim, remedy};
}

Suspect PatternOffset(const BoardSpec& board) {
  const Say claim = [](const FaultFit& fit) {
    return Format(
        "the pattern lies %.1f mm along the plate's width and %.1f mm along its height from where "
        "it is said to (+- %.1f)",
        kMmPerM * fit.Value(kPatternX),
        kMmPerM * fit.Value(kPatternY),
        kMmPerM * std::hypot(fit.StandardError(kPatternX), fit.StandardError(kPatternY)));
  };
  const Say remedy = [board](const FaultFit& fit) {
    const BoardSpec mended = BoardWith(fit.Faults(), board);
    return Format("board.pattern_offset_x_m: %.4f, pattern_offset_y_m: %.4f",
                  mended.pattern_offset_x_m,
                  mended.pattern_offset_y_m);
  };
  return {"pattern offset",
          "pattern offset",
          {kPatternX, kPatternY},
          0.5 * std::min(board.width_m, board.height_m),  // it would leave the plate
          false,
          kMmPerM,
          "mm",
          claim,
          remedy};
}

Suspect RangeOffset() {
  const Say claim = [](const FaultFit& fit) {
    return Format("the lidar's ranges are %.1f +- %.1f mm too %s",
                  kMmPerM * std::abs(fit.Value(kRangeOffset)),
                  kMmPerM * fit.StandardError(kRangeOffset),
                  fit.Value(kRangeOffset) > 0 ? "long" : "short");
  };
  const Say remedy = [](const FaultFit&) {
    return "take samples at more distances, which the refinement needs to take it out";
  };
  return {"lidar range offset",
          "lidar range offset",
          {kRangeOffset},
          0.3,
          false,
          kMmPerM,
          "mm",
          claim,
          remedy};
}

}  // namespace

Suspect PrincipalPoint(const CameraModel& camera) {
  const Say claim = [](const FaultFit& fit) {
    return Format(
        "the true principal point lies %.1f px right and %.1f px below that given (+- %.1f)",
        fit.Value(kPrincipalX),
        fit.Value(kPrincipalY),
        std::hypot(fit.StandardError(kPrincipalX), fit.StandardError(kPrincipalY)));
  };
  const Say remedy = [camera](const FaultFit& fit) {
    const CameraModel mended = CameraWith(fit.Faults(), camera);
    return Format("camera.cx_px: %.1f, cy_px: %.1f", mended.cx_px, mended.cy_px);
  };
  return {kPrincipalPointCause,
          kPrincipalPointCause,
          {kPrincipalX, kPrincipalY},
          0.25 * camera.width_px,
          true,
          1,
          "px",
          claim,
          remedy};
}

double Suspect::Length(const FaultFit& fit) const {
  double sum = 0;
  for (const FaultParameter fault : faults) sum += std::pow(fit.Value(fault), 2);
  return std::sqrt(sum);
}

double Suspect::LengthError(const FaultFit& fit) const {
  double sum = 0;
  for (const FaultParameter fault : faults) sum += std::pow(fit.StandardError(fault), 2);
  return std::sqrt(sum);
}

std::string SquaresLine(double square_m) {
  return Format("board.square_m: about %.5f; measure ten squares in a row with a rule", square_m);
}

std::string DistortionLine(const CameraModel& camera) {
  std::string text = "camera.distortion: [";
  for (int i = 0; i < NumDistortion(camera.lens); ++i) {
    text += Format(i == 0 ? "%g" : ", %g", camera.distortion[static_cast<std::size_t>(i)]);
  }
  return text + "]";
}

std::vector<Suspect> SuspectsOf(const BoardSpec& board, const CameraModel& camera) {
  std::vector<Suspect> suspects = {
      FocalLength("focal length", "focal length", kFocalScale, camera),
      FocalLength("focal length fx", "focal length across the image", kFocalXScale, camera),
      FocalLength("focal length fy", "focal length down the image", kFocalYScale, camera),
      PrincipalPoint(camera),
      Squares(board),
      PatternOffset(board),
      RangeOffset()};
  const int num_coefficients = std::min(NumDistortion(camera.lens), kSquareScale - kDistortion);
  for (int i = 0; i < num_coefficients; ++i) suspects.push_back(Coefficient(i, camera));
  return suspects;
}

}  // namespace voqcal
