#include "core/guidance/next_pose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/rigid.hpp"
#include "core/guidance/advice.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// Nearer in both is the same view again, with the same errors of lens and board.
constexpr double kNewDistanceM = 0.3;
constexpr double kNewAngleRad = 15.0 * kRadPerDeg;

// Both look ahead, upright: lidar x is camera z, lidar z is camera -y.
Eigen::Isometry3d LookingAlike() {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T_camera_lidar;
}

// Of the board's two half-turns, the one that leaves neither sensor upside down against the other.
Eigen::Isometry3d ExtrinsicOf(const BoardSample& sample) {
  const auto extrinsic = [&](const BoardPose& pose_lidar) {
    return TransformFromPose(sample.camera.pose) * TransformFromPose(pose_lidar).inverse();
  };
  const Eigen::Isometry3d T_camera_lidar = extrinsic(sample.lidar.pose);
  const double up = -T_camera_lidar.linear()(1, 2);  // lidar z along camera -y
  return up >= 0.0 ? T_camera_lidar : extrinsic(TurnedByHalf(sample.lidar.pose));
}

ExtrinsicBelief BeliefOf(const GuidanceState& state) {
  if (state.belief) return *state.belief;
  ExtrinsicBelief belief;
  belief.T_camera_lidar =
      state.samples.empty() ? LookingAlike() : ExtrinsicOf(*state.samples.back());
  return belief;
}

int NumRings(const std::vector<const BoardSample*>& samples, const SensorExpectation& sensors) {
  std::size_t num_rings = static_cast<std::size_t>(sensors.num_rows);
  for (const BoardSample* sample : samples) {
    for (const LidarPoint& point : sample->lidar.points_lidar_m.points) {
      if (point.ring < kMaxRings) num_rings = std::max(num_rings, std::size_t{point.ring} + 1);
    }
  }
  return static_cast<int>(num_rings);
}

// How many times larger than the samples' information allows each parameter's 1 sigma is.
Vector6d Widening(const std::optional<Matrix6d>& published, const Matrix6d& least) {
  if (!published) return Vector6d::Ones();
  return (published->diagonal().cwiseQuotient(least.diagonal())).cwiseSqrt().cwiseMax(1.0);
}

enum class Refusal { kNone, kOutOfView, kKnown, kTooFewRows };

struct Candidate {
  Placement placement;
  Refusal refusal = Refusal::kOutOfView;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  double worst_error = std::numeric_limits<double>::infinity();  // as of any refused
};

// Why none of the places that were looked at does, the most frequent reason first.
std::string RefusalWords(const std::vector<Candidate>& refused, const PlacementLimits& limits) {
  struct Reason {
    std::ptrdiff_t num_places;
    std::string text;
  };
  const auto reason = [&](Refusal refusal, const std::string& text) -> Reason {
    return {std::count_if(refused.begin(),
                          refused.end(),
                          [&](const Candidate& each) { return each.refusal == refusal; }),
            text};
  };
  std::array<Reason, 3> reasons = {
      reason(Refusal::kOutOfView, "not wholly in the view of camera and lidar within the limits"),
      reason(Refusal::kKnown, "like a sample's"),
      reason(Refusal::kTooFewRows,
             "where the lidar has fewer than " + std::to_string(limits.min_rows) + " rows")};
  std::stable_sort(reasons.begin(), reasons.end(), [](const Reason& a, const Reason& b) {
    return a.num_places > b.num_places;
  });
  std::string text =
      "nowhere can the board be held: of " + std::to_string(refused.size()) + " places ";
  for (std::size_t i = 0; i < reasons.size() && reasons[i].num_places > 0; ++i) {
    const auto& [num_places, why] = reasons[i];
    text += (i > 0 ? ", " : "") + std::to_string(num_places) +
            (num_places == 1 ? " is " : " are ") + why;
  }
  return text;
}

// Across the lidar's rows, so that they cross all four edges of a diamond. Where it looks along the
// camera's axis its rows are rings around that axis, and the image's up does as well.
Eigen::Vector3d UpOf(const Eigen::Isometry3d& T_camera_lidar) {
  constexpr double kLeastAngleRad = 30.0 * kRadPerDeg;
  const Eigen::Vector3d up_camera = T_camera_lidar.linear().col(2);
  const double sine = up_camera.head<2>().norm();
  return sine >= std::sin(kLeastAngleRad) ? up_camera : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
}

/// Judges placements and searches the best of them.
class PoseSearch {
 public:
  PoseSearch(const GuidanceState& state,
             const ExtrinsicBelief& belief,
             const GuidedRig& rig,
             const GuidanceOptions& options)
      : rig_(rig),
        options_(options),
        T_camera_lidar_(belief.T_camera_lidar),
        up_camera_(UpOf(belief.T_camera_lidar)),
        scene_(rig.camera, belief.T_camera_lidar, options.enough.tolerance),
        information_(
            state.samples, belief, rig.likelihood, NumRings(state.samples, options.sensors)),
        least_covariance_(information_.Covariance()),
        widening_(Widening(state.covariance, least_covariance_)),
        covariance_(state.covariance.value_or(least_covariance_)) {
    for (const BoardSample* sample : state.samples) {
      known_T_camera_board_.push_back(TransformFromPose(sample->camera.pose));
    }
  }

  WorstError WorstNow() const { return scene_.Worst(covariance_); }

  // Facing the camera; tilts are left to Climb.
  std::vector<Candidate> Grid() const {
    constexpr std::array<double, 5> kColumns = {0.15, 0.325, 0.5, 0.675, 0.85};
    constexpr std::array<double, 5> kRows = {0.3, 0.4, 0.5, 0.6, 0.7};
    constexpr std::array<double, 5> kDistances = {0.1, 0.3, 0.5, 0.7, 0.9};
    const double extent_m = options_.limits.max_distance_m - options_.limits.min_distance_m;
    std::vector<Candidate> candidates;
    for (const double column : kColumns) {
      for (const double row : kRows) {
        for (const double distance : kDistances) {
          Placement placement;
          placement.centre_px = {column * (rig_.camera.width_px - 1),
                                 row * (rig_.camera.height_px - 1)};
          placement.distance_m = options_.limits.min_distance_m + distance * extent_m;
          candidates.push_back(CandidateAt(placement));
        }
      }
    }
    return candidates;
  }

  // Searched from the best of `starts`; refused if all that it met are.
  Candidate Best(std::vector<Candidate> starts) const {
    constexpr std::size_t kNumStarts = 4;
    const std::size_t num_starts = std::min(kNumStarts, starts.size());
    std::partial_sort(starts.begin(),
                      starts.begin() + static_cast<std::ptrdiff_t>(num_starts),
                      starts.end(),
                      IsBetter);
    Candidate best;
    for (std::size_t i = 0; i < num_starts; ++i) best = std::min(best, Climb(starts[i]), IsBetter);
    return best;
  }

 private:
  static bool IsBetter(const Candidate& a, const Candidate& b) {
    return a.worst_error < b.worst_error;
  }

  Matrix6d Widened(const Matrix6d& covariance) const {
    return widening_.asDiagonal() * covariance * widening_.asDiagonal();
  }

  bool IsNew(const Eigen::Isometry3d& T_camera_board) const {
    return std::none_of(
        known_T_camera_board_.begin(), known_T_camera_board_.end(), [&](const auto& known) {
          return (known.translation() - T_camera_board.translation()).norm() < kNewDistanceM &&
                 AngleBetween(known.linear().col(2), T_camera_board.linear().col(2)) < kNewAngleRad;
        });
  }

  Candidate CandidateAt(const Placement& placement) const {
    Candidate candidate;
    candidate.placement = placement;
    const auto pose = PoseOf(placement, rig_.camera, up_camera_);
    if (!pose ||
        !IsInView(
            *pose, T_camera_lidar_, rig_.board, rig_.camera, options_.sensors, options_.limits)) {
      return candidate;
    }
    candidate.T_camera_board = *pose;
    candidate.refusal = Refusal::kKnown;
    if (!IsNew(*pose)) return candidate;
    const BoardSample sample =
        ExpectedSample(*pose, T_camera_lidar_, rig_.board, rig_.camera, options_.sensors);
    candidate.refusal = Refusal::kTooFewRows;
    if (sample.lidar.num_beams < options_.limits.min_rows) return candidate;
    candidate.refusal = Refusal::kNone;
    candidate.worst_error = scene_.Worst(Widened(information_.CovarianceWith(sample))).error;
    return candidate;
  }

  // Steps along each of the five numbers, both ways, as long as one of them is better; then halves.
  Candidate Climb(Candidate best) const {
    constexpr int kNumHalvings = 3;
    Placement step;
    step.centre_px = {0.1 * rig_.camera.width_px, 0.1 * rig_.camera.height_px};
    step.distance_m = 0.12 * (options_.limits.max_distance_m - options_.limits.min_distance_m);
    step.yaw_rad = step.pitch_rad = 15.0 * kRadPerDeg;
    for (int i = 0; i < kNumHalvings; ++i) {
      for (const double sign : {1.0, -1.0}) {
        const double share = sign / (1 << i);
        const auto attempt = [&](auto change) {
          Placement placement = best.placement;
          change(&placement);
          best = std::min(best, CandidateAt(placement), IsBetter);
        };
        attempt([&](Placement* p) { p->centre_px.x() += share * step.centre_px.x(); });
        attempt([&](Placement* p) { p->centre_px.y() += share * step.centre_px.y(); });
        attempt([&](Placement* p) { p->distance_m += share * step.distance_m; });
        attempt([&](Placement* p) { p->yaw_rad += share * step.yaw_rad; });
        attempt([&](Placement* p) { p->pitch_rad += share * step.pitch_rad; });
      }
    }
    return best;
  }

  const GuidedRig& rig_;
  const GuidanceOptions& options_;
  Eigen::Isometry3d T_camera_lidar_;
  Eigen::Vector3d up_camera_;
  ErrorScene scene_;
  ExtrinsicInformation information_;
  Matrix6d least_covariance_;
  Vector6d widening_;
  Matrix6d covariance_;
  std::vector<Eigen::Isometry3d> known_T_camera_board_;
};

}  // namespace

std::vector<std::string> GuidanceOptions::Problems() const {
  ProblemList problems;
  problems.Add(enough.Problems());
  problems.Add(sensors.Problems());
  problems.Add(limits.Problems());
  return problems.lines();
}

NextPose ProposeNextPose(const GuidanceState& state,
                         const GuidedRig& rig,
                         const GuidanceOptions& options) {
  RequireUsable("GuidanceOptions", options.Problems());
  const ExtrinsicBelief belief = BeliefOf(state);
  const PoseSearch search(state, belief, rig, options);
  NextPose next;
  next.worst = search.WorstNow();
  if (state.samples.empty()) next.worst.error = std::numeric_limits<double>::infinity();
  const Enough enough =
      JudgeEnough(static_cast<int>(state.samples.size()), next.worst, options.enough);
  next.is_enough = enough.is_enough && state.covariance;
  if (next.is_enough) next.advice = enough.words;
  const std::vector<Candidate> starts = search.Grid();
  const Candidate best = search.Best(starts);
  if (best.refusal != Refusal::kNone) {
    next.problem = RefusalWords(starts, options.limits);
    return next;
  }
  next.predicted_worst_error = best.worst_error;
  next.T_camera_board = best.T_camera_board;
  if (state.belief || !state.samples.empty()) {
    next.T_lidar_board = belief.T_camera_lidar.inverse() * best.T_camera_board;
  }
  if (next.is_enough) return next;
  std::optional<Eigen::Vector3d> last_centre_camera_m;
  if (!state.samples.empty()) last_centre_camera_m = state.samples.back()->camera.pose.centre_m;
  next.advice = HoldWords(next.T_camera_board, last_centre_camera_m, rig.camera);
  return next;
}

}  // namespace voqcal
