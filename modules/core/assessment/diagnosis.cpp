#include "core/assessment/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "core/assessment/fault_fit.hpp"
#include "core/assessment/judge_outline.hpp"
#include "core/assessment/judge_questions.hpp"
#include "core/assessment/judge_range_offset.hpp"
#include "core/assessment/judged_result.hpp"
#include "core/assessment/nested_models.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/median.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kLeastForModels = 5;  // of 6 residuals each, for 6 + 3 known and a group of 1 or 2

// Takes the samples that stand out from the equations, the worst first: each one pulls the fit.
void SetOutliersAside(const std::vector<FaultParameter>& known,
                      const DiagnosisOptions& options,
                      std::vector<FaultEquation>* equations,
                      Diagnosis* diagnosis) {
  while (equations->size() > kLeastForModels) {
    const FaultFit fit = FitFaults(*equations, known);
    if (!fit.is_usable) return;
    const std::vector<double> errors_m = CentreErrorsM(*equations, fit);
    const auto worst = std::max_element(errors_m.begin(), errors_m.end());
    const double median_m = Median(errors_m);
    if (*worst < options.max_outlier_factor * median_m || *worst < 0.01) return;
    const auto at = equations->begin() + (worst - errors_m.begin());
    Finding finding;
    finding.cause = "moving sample";
    finding.value = 1e3 * *worst;
    finding.unit = "mm";
    // Of taking it out: half the square of its error by the noise level, which is the median by
    // 1.54 for three normal errors together.
    finding.log_likelihood_gain = 0.5 * std::pow(1.54 * *worst / median_m, 2);
    finding.text = Format(
        "sample %lld is %.0f mm off where half of the others are within %.0f mm: "
        "the board moved, or something else was taken for it: discard the sample",
        static_cast<long long>(at->sample_id),
        finding.value,
        1e3 * median_m);
    diagnosis->findings.push_back(finding);
    equations->erase(at);
  }
}

void JudgeInconsistent(int num_inconsistent, std::size_t num_used, Diagnosis* diagnosis) {
  if (num_inconsistent == 0) return;
  Finding finding;
  finding.cause = "moving sample";
  finding.is_dealt_with = true;
  finding.value = num_inconsistent;
  finding.text = Format(
      "%d of %zu samples contradict the others: the board moved, or something else was taken for "
      "it; they were left out",
      num_inconsistent,
      num_used + static_cast<std::size_t>(num_inconsistent));
  diagnosis->findings.push_back(finding);
}

// RMS angle of directions from their mean.
double SpreadRad(const std::vector<Eigen::Vector3d>& directions) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& each : directions) mean += each.normalized();
  double sum = 0;
  for (const Eigen::Vector3d& each : directions) sum += std::pow(AngleBetween(each, mean), 2);
  return std::sqrt(sum / static_cast<double>(directions.size()));
}

void JudgePoses(const std::vector<const BoardSample*>& samples,
                const DiagnosisOptions& options,
                Diagnosis* diagnosis) {
  const auto report = [diagnosis](double value, const char* unit, const std::string& text) {
    Finding finding;
    finding.cause = "too few or too similar poses";
    finding.value = value;
    finding.unit = unit;
    finding.text = text;
    diagnosis->findings.push_back(finding);
  };
  if (static_cast<int>(samples.size()) < options.min_samples) {
    report(static_cast<double>(samples.size()),
           "samples",
           Format("%zu samples are few: show the board at %d places or more",
                  samples.size(),
                  options.min_samples));
  }
  if (samples.empty()) return;
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector3d> centres;
  for (const BoardSample* sample : samples) {
    normals.push_back(sample->camera.pose.normal);
    centres.push_back(sample->camera.pose.centre_m);
  }
  const double tilt_rad = SpreadRad(normals);
  if (tilt_rad < options.min_tilt_spread_rad) {
    report(kDegPerRad * tilt_rad,
           "deg",
           Format("the board always faces much the same way (its normals spread %.1f deg): tilt it "
                  "to all sides",
                  kDegPerRad * tilt_rad));
  }
  const double view_rad = SpreadRad(centres);
  if (view_rad < options.min_view_spread_rad) {
    report(kDegPerRad * view_rad,
           "deg",
           Format("the board is always in much the same direction (its centres spread %.1f deg): "
                  "show it left and right, high and low",
                  kDegPerRad * view_rad));
  }
}

// Those that the equations are of.
std::vector<const BoardSample*> SamplesOf(const std::vector<FaultEquation>& equations,
                                          const std::vector<const BoardSample*>& samples) {
  std::vector<const BoardSample*> kept;
  for (const BoardSample* sample : samples) {
    const bool is_kept =
        std::any_of(equations.begin(), equations.end(), [sample](const FaultEquation& equation) {
          return equation.sample_id == sample->id;
        });
    if (is_kept) kept.push_back(sample);
  }
  return kept;
}

// What must be mended first; then by the gain in likelihood; what has none to compare comes last.
// An answer without a free number (a turned sign) goes before one whose numbers, fitted to the same
// samples, gain hardly more.
void Rank(const DiagnosisOptions& options, std::vector<Finding>* findings) {
  const auto rank = [&options](const Finding& finding) {
    if (std::isnan(finding.log_likelihood_gain)) return -1.0;
    const double ahead = std::isnan(finding.value) ? options.min_log_likelihood_gain : 0.0;
    return finding.log_likelihood_gain + ahead;
  };
  std::stable_sort(findings->begin(), findings->end(), [&rank](const Finding& a, const Finding& b) {
    if (a.must_be_mended != b.must_be_mended) return a.must_be_mended;
    return rank(a) > rank(b);
  });
}

}  // namespace

std::vector<std::string> DiagnosisOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("min_log_likelihood_gain", min_log_likelihood_gain);
  problems.RequirePositive("min_moved_intervals", min_moved_intervals);
  problems.RequirePositive("max_range_offset_m", max_range_offset_m);
  problems.RequirePositive("min_edge_error_m", min_edge_error_m);
  problems.RequirePositive("min_side_error_m", min_side_error_m);
  problems.RequirePositive("max_outlier_factor", max_outlier_factor);
  problems.RequirePositive("min_samples", min_samples);
  problems.RequirePositive("min_tilt_spread_rad", min_tilt_spread_rad);
  problems.RequirePositive("min_view_spread_rad", min_view_spread_rad);
  return problems.lines();
}

Diagnosis Diagnose(const std::vector<const BoardSample*>& samples,
                   int num_inconsistent,
                   const BoardSpec& board,
                   const CameraModel& camera,
                   const Eigen::Isometry3d& T_camera_lidar,
                   const Matrix6d& covariance,
                   const BiasEstimate& range_offset,
                   const DiagnosisOptions& options) {
  RequireUsable("DiagnosisOptions", options.Problems());
  Diagnosis diagnosis;
  std::vector<FaultEquation> equations = MakeFaultEquations(samples, board, camera, T_camera_lidar);
  std::vector<FaultParameter> known = {kChessboardTurnX, kChessboardTurnY};
  if (range_offset.is_observable) known.push_back(kRangeOffset);
  SetOutliersAside(known, options, &equations, &diagnosis);
  const JudgedResult result{board, camera, T_camera_lidar, covariance, range_offset};
  const FaultFit plain = FitFaults(equations, known);
  const FaultFit models = JudgeModels(equations, known, result, options, &diagnosis);
  JudgeQuestions(SamplesOf(equations, samples), plain, known, result, options, &diagnosis);
  JudgeOutline(samples, board, {range_offset, RangeOffsetOf(models)}, options, &diagnosis);
  JudgeRangeOffset(range_offset, plain, models, options, &diagnosis);
  Rank(options, &diagnosis.findings);
  JudgeInconsistent(num_inconsistent, samples.size(), &diagnosis);
  JudgePoses(samples, options, &diagnosis);
  diagnosis.not_judged.push_back("time offset: samples are taken at rest, where it does not show");
  return diagnosis;
}

}  // namespace voqcal
