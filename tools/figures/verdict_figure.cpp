// Is every wrong input named, and no wrong result called usable? And is nothing said of clean ones?

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/assessment/lens_cause.hpp"
#include "core/camera_detection/planar_pose.hpp"
#include "core/simulation/simulation.hpp"
#include "figures/figures.hpp"
#include "figures/real_session.hpp"
#include "figures/session_faults.hpp"
#include "figures/simulated_session.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

struct VerdictArgs {
  std::filesystem::path rig;
  InputPaths input;  // nothing: simulated sessions
  int num_runs = 2;
  int num_clean = 10;
  int num_poses = 30;
  std::uint32_t seed = 1;
  std::string only;  // a fault's name
  bool is_verbose = false;
};

/// Given sessions, one a run, of poses that have the camera's pixels.
class BaseSessions {
 public:
  explicit BaseSessions(const VerdictArgs& args) : args_(args), rig_(LoadRig(args.rig)) {
    if (args.input.log) poses_ = LoadSession(rig_, args.input);
  }

  const Rig& rig() const { return rig_; }

  GivenSession Session(int run) const {
    GivenSession session{rig_.board, rig_.camera, {}};
    session.samples = poses_.empty() ? Simulated(run) : Drawn(run);
    SeeBoardsAgain(&session);
    return session;
  }

 private:
  // Of three quarters of a recording, at least 15; in order, as pairs are shifted.
  std::vector<BoardSample> Drawn(int run) const {
    const std::size_t num = std::max<std::size_t>(15, poses_.size() * 3 / 4);
    SessionPoses drawn = Shuffled(poses_, args_.seed, run);
    if (drawn.size() > num) drawn.resize(num);
    std::sort(drawn.begin(), drawn.end(), [](const SessionPose* a, const SessionPose* b) {
      return a->sample.id < b->sample.id;
    });
    return SamplesOf(drawn);
  }

  std::vector<BoardSample> Simulated(int run) const {
    SimulationOptions options = rig_.simulation;
    options.seed = args_.seed + static_cast<std::uint32_t>(run);
    options.num_poses = args_.num_poses;
    return SimulateProjected(rig_, options, {});
  }

  VerdictArgs args_;
  Rig rig_;
  std::vector<SessionPose> poses_;
};

/// What a user would be told of a session.
struct Told {
  CalibrationOutcome outcome;
  bool is_refused = true;  ///< No result, or "do not use".
  std::string cause;       ///< Named first; empty: none.
  std::string headline;
  std::vector<std::string> hidden;  ///< What the samples leave open, or could hide.
};

// Whether it is said that such a fault could hide, with what it would do.
bool IsSaidToHide(const Told& told, const SessionFault& fault) {
  for (const std::string& text : told.hidden) {
    for (const std::string& cause : fault.causes) {
      if (text.rfind(cause + ":", 0) == 0) return true;
    }
  }
  return false;
}

// "...; likely cause: shifted pairs: each image ...": where there is no result.
std::string CauseIn(const std::string& problem) {
  const std::string before = "likely cause: ";
  const std::size_t at = problem.find(before);
  if (at == std::string::npos) return "";
  const std::size_t from = at + before.size();
  return problem.substr(from, problem.find(':', from) - from);
}

// What the camera's board detector says of views that it refuses: their corners fit no pose well,
// make no sample, and tell of the lens if they are the most.
std::optional<LensCause> LensCauseOfRefused(const GivenSession& clean,
                                            const GivenSession& session,
                                            double max_rms_px) {
  const std::vector<Eigen::Vector3d> corners_board_m = session.board.InnerCornersBoardM();
  std::vector<std::vector<Eigen::Vector2d>> refused_px;
  for (const BoardSample& sample : clean.samples) {
    const auto fit = FitSeenCorners(session.camera, corners_board_m, sample.camera.corners_px);
    if (fit && fit->reprojection_rms_px <= max_rms_px) continue;
    refused_px.push_back(sample.camera.corners_px);
  }
  if (2 * refused_px.size() <= clean.samples.size()) return {};
  return FindLensCause(refused_px, session.board, session.camera, max_rms_px);
}

/// @param clean  the session without a fault.
Told Tell(const GivenSession& clean, GivenSession session, const Rig& rig) {
  CalibrationTask task = rig.Task();
  task.board = session.board;
  task.camera = session.camera;
  auto& samples = session.samples;
  const double max_rms_px = rig.camera_board_detector.max_reprojection_rms_px;
  samples.erase(std::remove_if(samples.begin(),
                               samples.end(),
                               [&](const BoardSample& sample) {
                                 return sample.camera.reprojection_rms_px > max_rms_px;
                               }),
                samples.end());
  Told told;
  told.outcome = Calibrate(samples, {}, task);
  told.headline = told.outcome.problem;
  if (!told.outcome.problem.empty()) {
    const auto lens = LensCauseOfRefused(clean, session, max_rms_px);
    told.cause = lens ? lens->cause : CauseIn(told.outcome.problem);
    return told;
  }
  told.hidden = told.outcome.calibration.diagnosis.not_judged;
  const Verdict verdict = VerdictOf(told.outcome.calibration);
  told.is_refused = verdict.grade == Grade::kBad;
  told.headline = verdict.headline;
  for (const Finding& finding : told.outcome.calibration.diagnosis.findings) {
    if (finding.is_dealt_with) continue;
    told.cause = finding.cause;
    break;
  }
  return told;
}

/// By how many of its 95 % intervals (of the lidar's place) the result moved, of the parameter that
/// moved most; infinite without a result.
double MovedIntervals(const CalibrationOutcome& clean, const CalibrationOutcome& faulty) {
  constexpr double kSigmas95 = 1.959964;
  if (!faulty.problem.empty()) return HUGE_VAL;
  const Vector6d difference =
      DifferenceLeft(clean.refined.T_camera_lidar, faulty.refined.T_camera_lidar);
  const Vector6d sigma = faulty.refined.covariance.diagonal().cwiseSqrt();
  if (!sigma.allFinite()) return HUGE_VAL;  // an interval that is not known holds nothing
  return (difference.cwiseAbs().cwiseQuotient(kSigmas95 * sigma)).maxCoeff();
}

/// Of one fault in one size.
struct Tally {
  int num = 0;
  int num_moved = 0;  // beyond the interval; the rest counts these alone
  int num_refused = 0;
  int num_named = 0;
  int num_another = 0;
  int num_hidden = 0;  // usable, no cause named, but it is said that this one could hide

  void Add(const Told& told, double moved, const SessionFault& fault) {
    ++num;
    if (!(moved > 1)) return;
    ++num_moved;
    num_refused += told.is_refused ? 1 : 0;
    const bool is_named =
        std::find(fault.causes.begin(), fault.causes.end(), told.cause) != fault.causes.end();
    num_named += is_named ? 1 : 0;
    num_hidden += !told.is_refused && told.cause.empty() && IsSaidToHide(told, fault) ? 1 : 0;
    num_another += !is_named && !told.cause.empty() ? 1 : 0;
  }

  void Add(const Tally& other) {
    num += other.num;
    num_moved += other.num_moved;
    num_refused += other.num_refused;
    num_named += other.num_named;
    num_another += other.num_another;
    num_hidden += other.num_hidden;
  }
};

void PrintTally(const std::string& name, const char* size, const Tally& tally) {
  std::printf("%-22s  %-7s  %4d  %6d  %10d  %5d  %7d  %10d\n",
              name.c_str(),
              size,
              tally.num,
              tally.num_moved,
              tally.num_refused,
              tally.num_named,
              tally.num_another,
              tally.num_hidden);
  std::fflush(stdout);
}

constexpr std::array<double, 3> kIntervals = {0.5, 1, 4};
constexpr std::array<const char*, 3> kSizeNames = {"half", "once", "4 times"};

// The sizes that move the result by so many intervals, by its effect at the probe's size.
std::vector<double> SizesOf(const SessionFault& fault,
                            const GivenSession& session,
                            const Told& clean,
                            const Rig& rig) {
  if (fault.probe == 0) return {1.0};
  GivenSession probed = session;
  fault.inject(fault.probe, &probed);
  const double moved = MovedIntervals(clean.outcome, Tell(session, probed, rig).outcome);
  std::vector<double> sizes;
  for (const double intervals : kIntervals) {
    sizes.push_back(std::min(fault.max_size, fault.probe * intervals / moved));
  }
  return sizes;
}

class FaultTable {
 public:
  explicit FaultTable(const VerdictArgs& args) : args_(args), tallies_(SessionFaults().size()) {}

  void Run(const GivenSession& session, const Rig& rig) {
    const Told clean = Tell(session, session, rig);
    if (!clean.outcome.problem.empty()) return;
    for (std::size_t i = 0; i < tallies_.size(); ++i) {
      const SessionFault& fault = SessionFaults()[i];
      if (!args_.only.empty() && args_.only != fault.name) continue;
      const std::vector<double> sizes = SizesOf(fault, session, clean, rig);
      tallies_[i].resize(sizes.size());
      for (std::size_t k = 0; k < sizes.size(); ++k) {
        GivenSession faulty = session;
        fault.inject(sizes[k], &faulty);
        const Told told = Tell(session, std::move(faulty), rig);
        const double moved = MovedIntervals(clean.outcome, told.outcome);
        tallies_[i][k].Add(told, moved, fault);
        if (args_.is_verbose) {
          std::printf("  %s %g: moved %.2f intervals; %s; %s\n",
                      fault.name,
                      sizes[k],
                      moved,
                      told.headline.c_str(),
                      told.cause.c_str());
        }
      }
    }
  }

  void Print() const {
    std::puts(
        "fault                   size     runs   moved  do not use  named  another  could hide");
    Tally all;
    for (std::size_t i = 0; i < tallies_.size(); ++i) {
      for (std::size_t k = 0; k < tallies_[i].size(); ++k) {
        const bool is_sized = tallies_[i].size() > 1;
        PrintTally(SessionFaults()[i].name, is_sized ? kSizeNames[k] : "-", tallies_[i][k]);
        all.Add(tallies_[i][k]);
      }
    }
    PrintTally("all", "", all);
    const double percent = 100.0 / std::max(all.num_moved, 1);
    std::printf(
        "of those that moved the result beyond its 95 %% interval: %.1f %% \"do not use\" (asked: "
        "98), %.1f %% named first (asked: 90), %.1f %% another (asked: at most 3); of %.1f %% it "
        "is said that "
        "the cause could hide\n",
        percent * all.num_refused,
        percent * all.num_named,
        percent * all.num_another,
        percent * all.num_hidden);
  }

 private:
  VerdictArgs args_;
  std::vector<std::vector<Tally>> tallies_;
};

void PrintClean(const VerdictArgs& args, const BaseSessions& base) {
  int num_caused = 0;
  int num_refused = 0;
  for (int run = 0; run < args.num_clean; ++run) {
    const GivenSession session = base.Session(run);
    const Told told = Tell(session, session, base.rig());
    num_caused += told.cause.empty() ? 0 : 1;
    num_refused += told.is_refused ? 1 : 0;
    if (args.is_verbose)
      std::printf("  clean: %s; %s\n", told.headline.c_str(), told.cause.c_str());
  }
  std::printf("clean sessions: %d; with a cause %d, \"do not use\" %d (asked: at most 2 %%)\n",
              args.num_clean,
              num_caused,
              num_refused);
  std::fflush(stdout);
}

void PrintVerdicts(const VerdictArgs& args) {
  const BaseSessions base(args);
  PrintClean(args, base);
  FaultTable table(args);
  for (int run = 0; run < args.num_runs; ++run) table.Run(base.Session(run), base.rig());
  table.Print();
}

}  // namespace

void AddVerdict(CLI::App* app) {
  const auto args = std::make_shared<VerdictArgs>();
  CLI::App* figure = app->add_subcommand(
      "verdict", "Is each fault of what is given named, and no wrong result called usable?");
  figure->add_option("--rig", args->rig, "The rig file (YAML); simulated unless there is a log")
      ->required();
  figure->add_option("--log", args->input.log, "A recording: its poses, three quarters a run");
  figure->add_option("--runs", args->num_runs, "Sessions that every fault is tried on")
      ->capture_default_str();
  figure->add_option("--clean", args->num_clean, "Sessions without a fault")->capture_default_str();
  figure->add_option("--num-poses", args->num_poses, "Poses of a simulated session")
      ->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the first run; the others follow")
      ->capture_default_str();
  figure->add_option("--fault", args->only, "This one alone");
  figure->add_flag("--verbose", args->is_verbose, "Print each run");
  figure->callback([args] { PrintVerdicts(*args); });
}

}  // namespace voqcal
