#include "core/assessment/nested_models.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/format.hpp"

namespace voqcal {
namespace {

/// One group of parameters that may be added to the plain fit.
struct Suspect {
  const char* cause;
  std::vector<FaultParameter> faults;
  double least;  // of the parameters' length: smaller does not matter
  double scale;  // from the parameter's unit to that of the text
  const char* unit;
};

std::vector<Suspect> Suspects(const DiagnosisOptions& options) {
  return {{"focal length", {kFocalScale}, options.min_focal_scale, 100, "%"},
          {"principal point", {kPrincipalX, kPrincipalY}, options.min_principal_point_px, 1, "px"},
          {"board's squares", {kSquareScale}, options.min_square_scale, 100, "%"},
          {"lidar range offset", {kRangeOffset}, options.min_range_offset_m, 1000, "mm"}};
}

struct Candidate {
  Suspect suspect;
  FaultFit fit;
  double gain = 0;
};

double Length(const FaultFit& fit, const std::vector<FaultParameter>& faults) {
  double sum = 0;
  for (const FaultParameter fault : faults) {
    sum += std::pow(fit.value[kNumExtrinsicParameters + fault], 2);
  }
  return std::sqrt(sum);
}

double LengthError(const FaultFit& fit, const std::vector<FaultParameter>& faults) {
  double sum = 0;
  for (const FaultParameter fault : faults) {
    sum += std::pow(fit.standard_error[kNumExtrinsicParameters + fault], 2);
  }
  return std::sqrt(sum);
}

// "calibrate the camera ...": what the user can do about it, with the rig file's keys.
std::string Remedy(FaultParameter fault) {
  switch (fault) {
    case kFocalScale:
      return "check camera.fx_px and fy_px in the rig file, or calibrate the camera again";
    case kPrincipalX:
      return "check camera.cx_px and cy_px in the rig file, or calibrate the camera again";
    case kSquareScale:
      return "measure the squares and give them as board.square_m";
    default:
      return "take samples at more distances, which the refinement needs to take it out";
  }
}

// "the focal length given is 2.0 +- 0.1 % too long": what is wrong with what was given.
std::string Claim(const Suspect& suspect, const FaultFit& fit) {
  const double value = suspect.scale * fit.value[kNumExtrinsicParameters + suspect.faults[0]];
  const double error = suspect.scale * LengthError(fit, suspect.faults);
  switch (suspect.faults[0]) {
    case kFocalScale:
      return Format("the focal length given is %.2f +- %.2f %% too %s",
                    std::abs(value),
                    error,
                    value < 0 ? "long" : "short");
    case kPrincipalX:
      return Format(
          "the true principal point lies %.1f px right and %.1f px below that given "
          "(+- %.1f)",
          value,
          fit.value[kNumExtrinsicParameters + kPrincipalY],
          error);
    case kSquareScale:
      return Format("the board's squares are given %.2f +- %.2f %% too %s",
                    std::abs(value),
                    error,
                    value < 0 ? "large" : "small");
    default:
      return Format("the lidar's ranges are %.1f +- %.1f mm too %s",
                    std::abs(value),
                    error,
                    value > 0 ? "long" : "short");
  }
}

// Of the centres in space: kinds with other units cannot be added without their noise levels, which
// differ between models.
double CentreSquares(const FaultFit& fit) { return fit.squares[kAcross] + fit.squares[kAlong]; }

Finding MakeFinding(const Candidate& candidate, const FaultFit& before) {
  const FaultFit& fit = candidate.fit;
  const std::vector<FaultParameter>& faults = candidate.suspect.faults;
  Finding finding;
  finding.cause = candidate.suspect.cause;
  finding.value =
      candidate.suspect.scale *
      (faults.size() == 1 ? fit.value[kNumExtrinsicParameters + faults[0]] : Length(fit, faults));
  finding.standard_error = candidate.suspect.scale * LengthError(fit, faults);
  finding.unit = candidate.suspect.unit;
  finding.log_likelihood_gain = candidate.gain;
  finding.explained = 1 - CentreSquares(fit) / CentreSquares(before);
  finding.held_out_before_mm = 1e3 * before.mean_held_out_error_m;
  finding.held_out_after_mm = 1e3 * fit.mean_held_out_error_m;
  finding.text = Claim(candidate.suspect, fit) +
                 Format(
                     ": explains %.0f %% of the centres' squared error in space; held out, it "
                     "falls from %.1f to %.1f mm",
                     100 * finding.explained,
                     finding.held_out_before_mm,
                     finding.held_out_after_mm) +
                 "; " + Remedy(faults[0]);
  return finding;
}

bool IsWorthAWord(const Candidate& candidate,
                  const FaultFit& before,
                  const DiagnosisOptions& options) {
  const FaultFit& fit = candidate.fit;
  const std::vector<FaultParameter>& faults = candidate.suspect.faults;
  const double length = Length(fit, faults);
  return candidate.gain > options.min_log_likelihood_gain && length > candidate.suspect.least &&
         length > 3 * LengthError(fit, faults) &&
         fit.mean_held_out_error_m < (1 - options.min_held_out_gain) * before.mean_held_out_error_m;
}

}  // namespace

void JudgeModels(const std::vector<FaultEquation>& equations,
                 const std::vector<FaultParameter>& known,
                 const DiagnosisOptions& options,
                 Diagnosis* diagnosis) {
  FaultFit now = FitFaults(equations, known);
  std::vector<FaultParameter> fitted = known;
  std::vector<Suspect> suspects = Suspects(options);
  const auto remove_suspects = [&suspects](const std::vector<FaultParameter>& faults) {
    suspects.erase(std::remove_if(suspects.begin(),
                                  suspects.end(),
                                  [&faults](const Suspect& each) { return each.faults == faults; }),
                   suspects.end());
  };
  for (const FaultParameter fault : known) remove_suspects({fault});
  while (now.is_usable && !suspects.empty()) {
    std::vector<Candidate> candidates;
    for (const Suspect& suspect : suspects) {
      std::vector<FaultParameter> faults = fitted;
      faults.insert(faults.end(), suspect.faults.begin(), suspect.faults.end());
      Candidate candidate{suspect, FitFaults(equations, faults)};
      if (!candidate.fit.is_usable) {
        if (fitted == known) {
          diagnosis->not_judged.push_back(std::string(suspect.cause) +
                                          ": the samples leave it open");
        }
        continue;
      }
      candidate.gain = candidate.fit.log_likelihood - now.log_likelihood;
      if (IsWorthAWord(candidate, now, options)) candidates.push_back(candidate);
    }
    const auto best = std::max_element(
        candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
          return a.gain < b.gain;
        });
    if (best == candidates.end()) return;
    diagnosis->findings.push_back(MakeFinding(*best, now));
    now = best->fit;
    fitted.insert(fitted.end(), best->suspect.faults.begin(), best->suspect.faults.end());
    remove_suspects(std::vector<FaultParameter>(best->suspect.faults));
  }
}

}  // namespace voqcal
