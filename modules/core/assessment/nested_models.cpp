#include "core/assessment/nested_models.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/assessment/judge_range_offset.hpp"
#include "core/assessment/suspects.hpp"
#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

struct Candidate {
  Suspect suspect;
  FaultFit fit;
  double gain = 0;
};

Vector6d MoveBetween(const FaultFit& before, const FaultFit& after) {
  return after.value.head<6>() - before.value.head<6>();
}

// Of the centres in space: kinds with other units cannot be added without their noise levels, which
// differ between models.
double CentreSquares(const FaultFit& fit) { return fit.squares[kAcross] + fit.squares[kAlong]; }

// Such a fault is there, also where the result's interval, widened by it, holds what it does.
bool HalvesTheError(const FaultFit& before, const FaultFit& fit) {
  return fit.mean_held_out_error_m < 0.5 * before.mean_held_out_error_m;
}

// As far as a cause may move the result, which is as uncertain as its own size.
double MostIntervals(const Suspect& suspect,
                     const FaultFit& fit,
                     const Vector6d& move,
                     const Matrix6d& covariance) {
  constexpr double kSigmas = 2.0;
  const double most = 1 + kSigmas * suspect.LengthError(fit) / suspect.Length(fit);
  return most * IntervalsOf(move, covariance);
}

// The result is wrong by a cause that may move it beyond its interval; by one that the rotation
// makes good, only if lidar points land elsewhere in the image, too, or if it turns by more than
// calibrations of one camera differ by.
void WeighMove(const Suspect& suspect,
               const Vector6d& move,
               const FaultFit& fit,
               const JudgedResult& result,
               Finding* finding) {
  finding->moved_intervals = IntervalsOf(move, result.covariance);
  finding->must_be_mended = MostIntervals(suspect, fit, move, result.covariance) > 1;
  finding->text += MoveText(move, result.covariance);
  if (!suspect.trades_rotation || !finding->must_be_mended) return;
  const Landing landing = LandingOf(CameraWith(fit.Faults(), result.camera), move, result);
  finding->must_be_mended = landing.intervals > 1 || move.head<3>().norm() > kMostCameraTurnRad;
  finding->text += Format(
      ", and lidar points in the image by %.1f px, %.1f times%s",
      landing.px,
      landing.intervals,
      finding->must_be_mended ? "" : ": use it only together with the intrinsics that were given");
}

Finding MakeFinding(const Candidate& candidate,
                    const FaultFit& before,
                    const JudgedResult& result) {
  const FaultFit& fit = candidate.fit;
  const Suspect& suspect = candidate.suspect;
  Finding finding;
  finding.cause = suspect.cause;
  finding.value = suspect.scale *
                  (suspect.faults.size() == 1 ? fit.Value(suspect.faults[0]) : suspect.Length(fit));
  finding.standard_error = suspect.scale * suspect.LengthError(fit);
  finding.unit = suspect.unit;
  finding.log_likelihood_gain = candidate.gain;
  finding.explained = 1 - CentreSquares(fit) / CentreSquares(before);
  finding.held_out_before_mm = kMmPerM * before.mean_held_out_error_m;
  finding.held_out_after_mm = kMmPerM * fit.mean_held_out_error_m;
  finding.text = suspect.claim(fit) + "; ";
  WeighMove(suspect, MoveBetween(before, fit), fit, result, &finding);
  if (HalvesTheError(before, fit)) finding.must_be_mended = true;
  finding.text += "; " + suspect.remedy(fit) +
                  Format(
                      " (explains %.0f %% of the centres' squared error in space; held out, it "
                      "falls from %.1f to %.1f mm)",
                      100 * finding.explained,
                      finding.held_out_before_mm,
                      finding.held_out_after_mm);
  return finding;
}

/// How much larger numbers are than others of the same poses: of pairs, as a pose that is far off
/// is so with both.
struct PairedGain {
  double sum = 0;
  double sigmas = 0;  ///< The sum by its standard error.
};

PairedGain GainOf(const std::vector<double>& larger, const std::vector<double>& smaller) {
  PairedGain gain;
  double sum2 = 0;
  for (std::size_t i = 0; i < larger.size(); ++i) {
    const double difference = larger[i] - smaller[i];
    gain.sum += difference;
    sum2 += difference * difference;
  }
  const double variance = sum2 - gain.sum * gain.sum / static_cast<double>(larger.size());
  gain.sigmas = gain.sum / std::sqrt(std::max(variance, 0.0));
  return gain;
}

// Whether it is far from none by its own standard error.
bool IsThere(const Candidate& candidate) {
  constexpr double kSigmas = 3.0;
  return candidate.suspect.Length(candidate.fit) >
         kSigmas * candidate.suspect.LengthError(candidate.fit);
}

constexpr double kLeastGainSigmas = 2.5;

// Whether poses held out fit better: their centres...
bool CentresFitBetter(const Candidate& candidate,
                      const FaultFit& before,
                      const DiagnosisOptions& options) {
  // What no model has (edges that beams widen, a plate that is not quite flat) leaves errors that
  // one parameter or another takes up in part, far beyond what white noise would: so the error of
  // poses held out must fall, and for so many of them that it is no chance.
  constexpr double kLeastFall = 0.1;
  // ...or normals and corners gain the more, the less it falls: six times the least that is worth a
  // word with a fall of a tenth.
  constexpr double kLeastGainByFall = 0.6;
  const FaultFit& fit = candidate.fit;
  const double fall = 1 - fit.mean_held_out_error_m / before.mean_held_out_error_m;
  if (!(fall > kLeastFall)) return false;
  return GainOf(before.held_out_errors_m, fit.held_out_errors_m).sigmas > kLeastGainSigmas ||
         fall * candidate.gain > kLeastGainByFall * options.min_log_likelihood_gain;
}

// ...or all that they tell. (By this alone, parameters that move centres along the view gain on
// clean recordings, too.)
bool AllFitsBetter(const FaultFit& before, const FaultFit& fit, const DiagnosisOptions& options) {
  const int num = static_cast<int>(fit.held_out_log_likelihoods.size());
  if (num < options.min_samples) return false;  // of few, a standard error says little
  const PairedGain gain = GainOf(fit.held_out_log_likelihoods, before.held_out_log_likelihoods);
  return gain.sum > options.min_log_likelihood_gain && gain.sigmas > kLeastGainSigmas;
}

// Beyond chance, also for samples that it was not fitted to, and of consequence: it moves the
// result beyond what is said of it.
bool IsWorthAWord(const Candidate& candidate,
                  const FaultFit& before,
                  const Matrix6d& covariance,
                  const DiagnosisOptions& options) {
  const FaultFit& fit = candidate.fit;
  const Suspect& suspect = candidate.suspect;
  if (!(candidate.gain > options.min_log_likelihood_gain)) return false;
  if (!IsThere(candidate)) return false;
  // What the rotation makes good leaves the centres where they are: normals and corners show it.
  const bool is_held_out_better = CentresFitBetter(candidate, before, options) ||
                                  (suspect.trades_rotation && AllFitsBetter(before, fit, options));
  return is_held_out_better && (HalvesTheError(before, fit) ||
                                MostIntervals(suspect, fit, MoveBetween(before, fit), covariance) >
                                    options.min_moved_intervals);
}

bool Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Two digits that count, never as 1.3e+02.
int DecimalsOf(double value) {
  return std::max(0, 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
}

// As large as the samples allow.
double LargestSize(const Candidate& candidate, FaultParameter fault) {
  constexpr double kSigmas = 2.0;
  return std::abs(candidate.fit.Value(fault)) + kSigmas * candidate.fit.StandardError(fault);
}

// Whether the samples say no more of it than anyone knows.
bool IsOpen(const Candidate& candidate) {
  return std::any_of(candidate.suspect.faults.begin(),
                     candidate.suspect.faults.end(),
                     [&candidate](FaultParameter fault) {
                       return LargestSize(candidate, fault) > candidate.suspect.most;
                     });
}

// A fault that the samples do not tell from none.
struct Hidden {
  std::string group;
  double intervals = 0;  // of the result, that it would move it by
  std::string text;
};

Hidden WhatCouldHide(const Candidate& candidate, const Matrix6d& covariance) {
  const Suspect& suspect = candidate.suspect;
  Hidden worst;
  for (const FaultParameter fault : suspect.faults) {
    const double size = LargestSize(candidate, fault);
    const Vector6d move = size * candidate.fit.ExtrinsicBy(fault);
    const double intervals = IntervalsOf(move, covariance);
    if (!(intervals > std::max(worst.intervals, 1.0))) continue;
    worst = {suspect.group,
             intervals,
             Format("%s: an error of %.*f%s could hide in these samples; ",
                    suspect.cause.c_str(),
                    DecimalsOf(suspect.scale * size),
                    suspect.scale * size,
                    suspect.unit.empty() ? "" : (" " + suspect.unit).c_str()) +
                 MoveText(move, covariance)};
  }
  return worst;
}

void SayWhatIsOpen(const std::vector<std::string>& groups, Diagnosis* diagnosis) {
  if (groups.empty()) return;
  std::string text;
  for (const std::string& group : groups) text += (text.empty() ? "" : ", ") + group;
  diagnosis->not_judged.push_back(text + ": the samples leave it open");
}

// The turn that every fit has is what a wrong principal point does, and takes it up: it is asked
// whether that explains the samples where nothing else has taken the turn out.
bool ExplainTheTurn(const std::vector<FaultEquation>& equations,
                    const std::vector<FaultParameter>& fitted,
                    const JudgedResult& result,
                    const DiagnosisOptions& options,
                    Diagnosis* diagnosis) {
  std::vector<FaultParameter> faults;
  for (const FaultParameter fault : fitted) {
    if (fault == kPrincipalX) return false;  // is found already
    if (fault != kChessboardTurnX && fault != kChessboardTurnY) faults.push_back(fault);
  }
  const FaultFit before = FitFaults(equations, faults);
  Candidate candidate{PrincipalPoint(result.camera), {}};
  faults.insert(faults.end(), candidate.suspect.faults.begin(), candidate.suspect.faults.end());
  candidate.fit = FitFaults(equations, faults);
  if (!before.is_usable || !candidate.fit.is_usable) return false;
  candidate.gain = candidate.fit.log_likelihood - before.log_likelihood;
  if (!IsWorthAWord(candidate, before, result.covariance, options)) return false;
  diagnosis->findings.push_back(MakeFinding(candidate, before, result));
  return true;
}

/// Every suspect that may be added to a fit, tried.
struct Round {
  std::vector<Candidate> candidates;     // that have a fit
  std::vector<std::string> open_groups;  // of which the samples say nothing
};

Round TryEach(const std::vector<FaultEquation>& equations,
              const std::vector<Suspect>& suspects,
              const std::vector<FaultParameter>& fitted,
              const FaultFit& now) {
  Round round;
  for (const Suspect& suspect : suspects) {
    std::vector<FaultParameter> faults = fitted;
    faults.insert(faults.end(), suspect.faults.begin(), suspect.faults.end());
    Candidate candidate{suspect, FitFaults(equations, faults)};
    candidate.gain = candidate.fit.log_likelihood - now.log_likelihood;
    const bool is_open = !candidate.fit.is_usable || IsOpen(candidate);
    if (is_open && !Contains(round.open_groups, suspect.group)) {
      round.open_groups.push_back(suspect.group);
    }
    if (candidate.fit.is_usable) round.candidates.push_back(candidate);
  }
  return round;
}

// Of each group the worst that could, but for those that are open.
void SayWhatCouldHide(const Round& round, const Matrix6d& covariance, Diagnosis* diagnosis) {
  std::vector<Hidden> worst;
  for (const Candidate& candidate : round.candidates) {
    const Hidden hidden = WhatCouldHide(candidate, covariance);
    if (hidden.text.empty() || Contains(round.open_groups, hidden.group)) continue;
    const auto of_group = std::find_if(worst.begin(), worst.end(), [&hidden](const Hidden& each) {
      return each.group == hidden.group;
    });
    if (of_group == worst.end()) {
      worst.push_back(hidden);
    } else if (hidden.intervals > of_group->intervals) {
      *of_group = hidden;
    }
  }
  for (const Hidden& hidden : worst) diagnosis->not_judged.push_back(hidden.text);
}

/// The one that helps most of those that are worth a word; null if none is.
const Candidate* BestOf(const Round& round,
                        const FaultFit& now,
                        const Matrix6d& covariance,
                        const DiagnosisOptions& options) {
  const Candidate* best = nullptr;
  for (const Candidate& candidate : round.candidates) {
    if (!IsWorthAWord(candidate, now, covariance, options)) continue;
    if (best == nullptr || candidate.gain > best->gain) best = &candidate;
  }
  return best;
}

// An offset that no lidar has comes from elsewhere, whatever that is. So the suspects that leave a
// possible one are compared with a broken lidar, not with nothing: the likeliest by the samples and
// by what is known of lidars is a finding, also if the result, which has the offset instead, hardly
// moves.
std::optional<Candidate> WhatTheOffsetIs(const Round& round,
                                         const FaultFit& now,
                                         const JudgedResult& result,
                                         const DiagnosisOptions& options) {
  if (!IsBeyondLidars(result.range_offset, options)) return {};
  if (!IsBeyondLidars(RangeOffsetOf(now), options)) return {};
  std::optional<Candidate> best;
  const double prior_now = LogPriorOfRangeOffset(now.Value(kRangeOffset), options);
  for (Candidate candidate : round.candidates) {
    if (!IsThere(candidate) || IsBeyondLidars(RangeOffsetOf(candidate.fit), options)) continue;
    candidate.gain += LogPriorOfRangeOffset(candidate.fit.Value(kRangeOffset), options) - prior_now;
    if (candidate.gain > (best ? best->gain : options.min_log_likelihood_gain)) best = candidate;
  }
  return best;
}

// Whether it was worth a word also before anything else was found.
bool StandsAlone(const Suspect& suspect,
                 const Round& first,
                 const FaultFit& plain,
                 const JudgedResult& result,
                 const DiagnosisOptions& options) {
  return std::any_of(first.candidates.begin(), first.candidates.end(), [&](const Candidate& each) {
    return each.suspect.faults == suspect.faults &&
           IsWorthAWord(each, plain, result.covariance, options);
  });
}

void Remove(const std::vector<FaultParameter>& faults, std::vector<Suspect>* suspects) {
  suspects->erase(std::remove_if(suspects->begin(),
                                 suspects->end(),
                                 [&faults](const Suspect& each) { return each.faults == faults; }),
                  suspects->end());
}

}  // namespace

FaultFit JudgeModels(const std::vector<FaultEquation>& equations,
                     const std::vector<FaultParameter>& known,
                     const JudgedResult& result,
                     const DiagnosisOptions& options,
                     Diagnosis* diagnosis) {
  FaultFit now = FitFaults(equations, known);
  if (!now.is_usable) {
    diagnosis->not_judged.push_back("what was given: the samples leave the extrinsic itself open");
    return now;
  }
  std::vector<FaultParameter> fitted = known;
  std::vector<Suspect> suspects = SuspectsOf(result.board, result.camera);
  for (const FaultParameter fault : known) Remove({fault}, &suspects);
  Round round = TryEach(equations, suspects, fitted, now);
  const Round first = round;
  const FaultFit plain = now;
  const std::size_t begin = diagnosis->findings.size();
  const auto take = [&](const Candidate& candidate) {
    diagnosis->findings.push_back(MakeFinding(candidate, now, result));
    // What is only seen once others are mended asks for mending these.
    if (diagnosis->findings.back().must_be_mended &&
        !StandsAlone(candidate.suspect, first, plain, result, options)) {
      for (std::size_t i = begin; i < diagnosis->findings.size(); ++i)
        diagnosis->findings[i].must_be_mended = true;
    }
    now = candidate.fit;
    const std::vector<FaultParameter>& added = candidate.suspect.faults;
    fitted.insert(fitted.end(), added.begin(), added.end());
    Remove(added, &suspects);
    round = TryEach(equations, suspects, fitted, now);
  };
  while (const Candidate* best = BestOf(round, now, result.covariance, options)) take(*best);
  if (const auto cause = WhatTheOffsetIs(round, now, result, options)) {
    take(*cause);
    Finding& finding = diagnosis->findings.back();
    finding.must_be_mended = true;
    finding.text += Format(
        "; instead of it %.0f mm were taken out of the lidar's ranges, more than "
        "lidars err",
        kMmPerM * result.range_offset.value_m);
  }
  if (ExplainTheTurn(equations, fitted, result, options, diagnosis)) {
    Remove(PrincipalPoint(result.camera).faults, &suspects);
    round = TryEach(equations, suspects, fitted, now);
  }
  SayWhatIsOpen(round.open_groups, diagnosis);
  SayWhatCouldHide(round, result.covariance, diagnosis);
  return now;
}

}  // namespace voqcal
