#include "core/calibration/calibration.hpp"

#include <algorithm>

#include "core/camera/image_parts.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

std::vector<std::string> PartsWithout(const std::vector<ScoreBin>& bins) {
  std::vector<std::string> empty;
  for (const std::string& part : ImagePartNames()) {
    const auto is_it = [&](const ScoreBin& bin) { return bin.name == part; };
    if (std::none_of(bins.begin(), bins.end(), is_it)) empty.push_back(part);
  }
  return empty;
}

Evidence EvidenceOf(const Calibration& calibration) {
  const Vector6d sigma = calibration.covariance_given_rig.diagonal().cwiseSqrt();
  Evidence evidence;
  evidence.held_out_mm = calibration.held_out.centre_mm.mean;
  evidence.in_sample_mm = calibration.in_sample.centre_mm.mean;
  evidence.normal_deg = calibration.held_out.normal_deg.mean;
  evidence.chessboard_turn_deg = kDegPerRad * calibration.chessboard_turn.value_rad.norm();
  evidence.sigma_deg = kDegPerRad * sigma.head<3>().maxCoeff();
  evidence.sigma_mm = kMmPerM * sigma.tail<3>().norm();
  evidence.num_used = static_cast<int>(calibration.used_ids.size());
  evidence.is_enough = calibration.enough.is_enough;
  evidence.enough_words = calibration.enough.words;
  evidence.num_samples =
      static_cast<int>(calibration.used_ids.size() + calibration.rejected.size());
  evidence.other_lens = OtherLens(calibration.lens_correction, calibration.held_out);
  evidence.empty_parts = PartsWithout(calibration.held_out_by_cell);
  evidence.scene = calibration.scene_check.verdict;
  evidence.scene_reason = calibration.scene_check.reason;
  for (const Finding& finding : calibration.diagnosis.findings) {
    if (finding.is_dealt_with) continue;
    evidence.likeliest_fault = finding.text;
    evidence.likeliest_cause = finding.cause;
    evidence.must_be_mended = finding.must_be_mended;
    break;
  }
  return evidence;
}

}  // namespace

Verdict VerdictOf(const Calibration& calibration) { return VerdictOf(EvidenceOf(calibration)); }

}  // namespace voqcal
