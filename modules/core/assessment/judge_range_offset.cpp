#include "core/assessment/judge_range_offset.hpp"

#include <algorithm>
#include <cmath>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {

bool IsBeyondLidars(const BiasEstimate& range_offset, const DiagnosisOptions& options) {
  constexpr double kSigmas = 2.0;
  const double least_m = std::abs(range_offset.value_m) - kSigmas * range_offset.standard_error_m;
  return range_offset.is_observable && least_m > options.max_range_offset_m;
}

BiasEstimate RangeOffsetOf(const FaultFit& fit) {
  const double error_m = fit.StandardError(kRangeOffset);
  return {fit.Value(kRangeOffset), error_m, fit.is_usable && error_m > 0};
}

double LogPriorOfRangeOffset(double offset_m, const DiagnosisOptions& options) {
  const double sigmas = offset_m / (0.5 * options.max_range_offset_m);
  return -std::min(0.5 * sigmas * sigmas, options.min_log_likelihood_gain);
}

void JudgeRangeOffset(const BiasEstimate& range_offset,
                      const FaultFit& plain,
                      const FaultFit& models,
                      const DiagnosisOptions& options,
                      Diagnosis* diagnosis) {
  if (!IsBeyondLidars(range_offset, options)) return;
  const bool is_explained = IsBeyondLidars(RangeOffsetOf(plain), options) &&
                            !IsBeyondLidars(RangeOffsetOf(models), options);
  if (is_explained) return;
  Finding finding;
  finding.cause = "lidar range offset";
  finding.value = kMmPerM * range_offset.value_m;
  finding.standard_error = kMmPerM * range_offset.standard_error_m;
  finding.unit = "mm";
  finding.must_be_mended = true;
  finding.text = Format(
      "%.0f +- %.0f mm were taken out of the lidar's ranges, more than lidars err: squares or a "
      "focal length given too %s look the same; check board.square_m, camera.fx_px and fy_px",
      finding.value,
      finding.standard_error,
      range_offset.value_m < 0 ? "large" : "small");
  diagnosis->findings.push_back(finding);
}

}  // namespace voqcal
