#include "result/verdict_yaml.hpp"

#include "core/units.hpp"
#include "result/assessment_yaml.hpp"

namespace voqcal {
namespace {

Evidence EvidenceOf(const CalibrationResult& result) {
  const Vector6d sigma = result.covariance.diagonal().cwiseSqrt();
  Evidence evidence;
  evidence.held_out_mm = result.held_out.centre_mm.mean;
  evidence.in_sample_mm = result.in_sample.centre_mm.mean;
  evidence.normal_deg = result.held_out.normal_deg.mean;
  evidence.sigma_deg = kDegPerRad * sigma.head<3>().maxCoeff();
  evidence.sigma_mm = kMmPerM * sigma.tail<3>().maxCoeff();
  evidence.num_used = static_cast<int>(result.used_ids.size());
  evidence.num_samples = static_cast<int>(result.used_ids.size() + result.rejected.size());
  evidence.num_cells = static_cast<int>(result.held_out_by_cell.size());
  evidence.scene = result.scene_check.verdict;
  evidence.scene_reason = result.scene_check.reason;
  evidence.likeliest_fault = LikeliestFault(result.diagnosis.findings);
  return evidence;
}

}  // namespace

Verdict VerdictOf(const CalibrationResult& result) { return VerdictOf(EvidenceOf(result)); }

std::string VerdictYaml(const Verdict& verdict) {
  std::string text =
      "verdict:\n"
      "  grade: " +
      ToString(verdict.grade) +
      "  # the worst of the checks: good; look: usable, read why; bad: do not use\n"
      "  headline: " +
      QuotedYaml(verdict.headline) + "\n  checks:\n";
  for (const VerdictCheck& check : verdict.checks) {
    text += "    - {name: " + QuotedYaml(check.name) + ", grade: " + ToString(check.grade) +
            ", text: " + QuotedYaml(check.text) + "}\n";
  }
  return text;
}

}  // namespace voqcal
