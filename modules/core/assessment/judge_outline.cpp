#include "core/assessment/judge_outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/format.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// By how much edges are given longer than the lidar measures them freely.
struct EdgeErrors {
  double sum_m = 0;
  double sum_m2 = 0;
  int num = 0;

  void Add(double error_m) {
    if (std::isnan(error_m)) return;  // an open edge says nothing of the size
    sum_m += error_m;
    sum_m2 += error_m * error_m;
    ++num;
  }
  double MeanM() const { return sum_m / num; }
  // Edges that happen to agree are no better known than a lidar measures one.
  double VarianceM2() const { return std::max(1e-6, sum_m2 / num - MeanM() * MeanM()); }
  double StandardErrorM() const { return std::sqrt(VarianceM2() / num); }
  double Gain() const { return 0.5 * num * std::log1p(MeanM() * MeanM() / VarianceM2()); }
};

Finding OutlineFinding(const char* cause, const EdgeErrors& errors) {
  Finding finding;
  finding.cause = cause;
  finding.must_be_mended = true;
  finding.value = kMmPerM * errors.MeanM();
  finding.standard_error = kMmPerM * errors.StandardErrorM();
  finding.unit = "mm";
  finding.log_likelihood_gain = errors.Gain();
  finding.explained =
      std::pow(errors.MeanM(), 2) / (std::pow(errors.MeanM(), 2) + errors.VarianceM2());
  return finding;
}

std::string GivenTooLong(const EdgeErrors& errors) {
  return Format("%.0f +- %.0f mm %s than the lidar measures",
                kMmPerM * std::abs(errors.MeanM()),
                kMmPerM * errors.StandardErrorM(),
                errors.MeanM() > 0 ? "longer" : "shorter");
}

struct OutlineErrors {
  EdgeErrors all;
  EdgeErrors widths;
  EdgeErrors heights;
};

// Ranges that are too long by `offset_m` show a board too far, and too large by as much.
OutlineErrors ErrorsOf(const std::vector<const BoardSample*>& samples,
                       const BoardSpec& board,
                       double offset_m) {
  const auto given_lengths_m = board.EdgeLengthsM();
  OutlineErrors errors;
  for (const BoardSample* sample : samples) {
    const double share = 1 - offset_m / sample->lidar.pose.centre_m.norm();
    for (std::size_t i = 0; i < given_lengths_m.size(); ++i) {
      const double error_m = given_lengths_m[i] - share * sample->lidar.edge_lengths_m[i];
      errors.all.Add(error_m);
      (i % 2 == 0 ? errors.widths : errors.heights).Add(error_m);
    }
  }
  return errors;
}

// An offset may be the lidar's own or that of squares, which leave the outline alone: whichever
// explains the edges.
OutlineErrors LeastErrorsOf(const std::vector<const BoardSample*>& samples,
                            const BoardSpec& board,
                            const std::vector<BiasEstimate>& range_offsets) {
  OutlineErrors least = ErrorsOf(samples, board, 0.0);
  for (const BiasEstimate& offset : range_offsets) {
    if (!offset.is_observable) continue;
    const OutlineErrors corrected = ErrorsOf(samples, board, offset.value_m);
    if (std::abs(corrected.all.MeanM()) < std::abs(least.all.MeanM())) least = corrected;
  }
  return least;
}

bool IsOneSideWrong(const OutlineErrors& errors, const DiagnosisOptions& options) {
  const double difference_m = errors.widths.MeanM() - errors.heights.MeanM();
  const double error_m =
      std::hypot(errors.widths.StandardErrorM(), errors.heights.StandardErrorM());
  const double sigmas = difference_m / error_m;
  return std::abs(difference_m) > options.min_side_error_m &&
         0.5 * sigmas * sigmas > options.min_log_likelihood_gain;
}

Finding SideFinding(const OutlineErrors& errors, const BoardSpec& board) {
  const bool is_width = std::abs(errors.widths.MeanM()) > std::abs(errors.heights.MeanM());
  const EdgeErrors& wrong = is_width ? errors.widths : errors.heights;
  Finding finding = OutlineFinding(is_width ? "board's width" : "board's height", wrong);
  finding.text = Format("the board's %s is given ", is_width ? "width" : "height") +
                 GivenTooLong(wrong) +
                 Format(" it; measure it: board.%s: %.3f?",
                        is_width ? "width_m" : "height_m",
                        (is_width ? board.width_m : board.height_m) - wrong.MeanM());
  return finding;
}

}  // namespace

void JudgeOutline(const std::vector<const BoardSample*>& samples,
                  const BoardSpec& board,
                  const std::vector<BiasEstimate>& range_offsets,
                  const DiagnosisOptions& options,
                  Diagnosis* diagnosis) {
  const OutlineErrors errors = LeastErrorsOf(samples, board, range_offsets);
  constexpr int kLeastEdges = 5;  // on each side: fewer may all be off alike
  if (errors.widths.num < kLeastEdges || errors.heights.num < kLeastEdges) return;
  if (IsOneSideWrong(errors, options)) {
    diagnosis->findings.push_back(SideFinding(errors, board));
    return;
  }
  const EdgeErrors& all = errors.all;
  if (std::abs(all.MeanM()) < options.min_edge_error_m ||
      all.Gain() < options.min_log_likelihood_gain) {
    return;
  }
  Finding finding = OutlineFinding("board's outline", all);
  finding.text = "the board's edges are given " + GivenTooLong(all) +
                 Format(
                     " them: explains %.0f %% of the squared edge errors; measure the board and "
                     "give it as board.width_m and height_m",
                     100 * finding.explained);
  diagnosis->findings.push_back(finding);
}

}  // namespace voqcal
