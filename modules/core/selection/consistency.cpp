#include "core/selection/consistency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/board/what_was_measured.hpp"
#include "core/geometry/rigid.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// How far two poses are from agreeing, in units of what is allowed: 1 is the limit.
struct PairError {
  double distance_m = 0.0;
  double angle_rad = 0.0;
  double max_distance_m = 0.0;  // the limits
  double max_angle_rad = 0.0;
  double relative = 0.0;  // the worst over its limit

  bool Agrees() const { return relative <= 1.0; }  // false for NaN
};

// One of the lidar's candidates for the board of a sample.
struct Candidate {
  std::size_t sample = 0;
  int rank = 0;  // 0: the sample's likeliest
};

std::vector<Candidate> CandidatesOf(const std::vector<BoardSample>& samples) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int rank = 0; rank <= static_cast<int>(samples[i].runners_up.size()); ++rank) {
      candidates.push_back({i, rank});
    }
  }
  return candidates;
}

// How far a board's centre may be off along a direction, and its normal across (3 sigma of its
// covariance): a centre that not all sides fix, a pose from few pixels.
struct Slack {
  Eigen::Matrix3d of_centre;
  double angle_rad = 0.0;

  explicit Slack(const BoardPose& pose) {
    constexpr double kSquaredSigmas = 9.0;
    of_centre = kSquaredSigmas * pose.covariance.bottomRightCorner<3, 3>();
    const Eigen::Matrix3d of_rotation = kSquaredSigmas * pose.covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d& n = pose.normal;
    // Half of what tilts the normal: the turn about it does not.
    angle_rad = std::sqrt(0.5 * std::max(0.0, of_rotation.trace() - n.dot(of_rotation * n)));
  }

  double Along(const Eigen::Vector3d& direction) const {
    return std::sqrt(std::max(0.0, direction.dot(of_centre * direction)));
  }
};

// Of both boards of a pair, in one sensor.
struct PairSlack {
  Slack a;
  Slack b;

  double Along(const Eigen::Vector3d& direction) const {
    return std::hypot(a.Along(direction), b.Along(direction));
  }
  double AngleRad() const { return std::hypot(a.angle_rad, b.angle_rad); }
};

// Three things that are the same in both sensors whatever the extrinsic is: the distance of the
// centres, the angle of the normals, and how far each centre lies off the other's plane. The last
// follows from the others but where a centre is uncertain within its plane; it is judged there
// alone.
PairError ComparePair(const std::array<std::reference_wrapper<const LidarBoard>, 2>& lidar,
                      const std::array<std::reference_wrapper<const BoardPose>, 2>& camera,
                      const ConsistencyOptions& options) {
  const BoardPose& la = lidar[0].get().pose;
  const BoardPose& lb = lidar[1].get().pose;
  const BoardPose& ca = camera[0];
  const BoardPose& cb = camera[1];
  const PairSlack slack_lidar{Slack(la), Slack(lb)};
  const PairSlack slack_camera{Slack(ca), Slack(cb)};
  const Eigen::Vector3d lidar_m = lb.centre_m - la.centre_m;
  const Eigen::Vector3d camera_m = cb.centre_m - ca.centre_m;
  const auto limit_m = [&](const Eigen::Vector3d& in_lidar, const Eigen::Vector3d& in_camera) {
    return std::hypot(options.max_distance_m,
                      std::hypot(slack_lidar.Along(in_lidar), slack_camera.Along(in_camera)));
  };
  PairError error;
  error.distance_m = std::abs(lidar_m.norm() - camera_m.norm());
  error.angle_rad =
      std::abs(AngleBetween(la.normal, lb.normal) - AngleBetween(ca.normal, cb.normal));
  error.max_distance_m = limit_m(lidar_m.normalized(), camera_m.normalized());
  error.max_angle_rad = std::hypot(options.max_angle_rad,
                                   std::hypot(slack_lidar.AngleRad(), slack_camera.AngleRad()));
  const double by_distance = error.distance_m / error.max_distance_m;
  const double by_angle = error.angle_rad / error.max_angle_rad;
  // Not std::max, which would hide a NaN.
  error.relative = by_distance > by_angle ? by_distance : by_angle;
  if (std::isnan(by_distance)) error.relative = by_distance;
  if (IsWhole(lidar[0]) && IsWhole(lidar[1])) return error;
  const double turned_m = error.max_angle_rad * camera_m.norm();
  for (const auto& [normal_lidar, normal_camera] :
       {std::pair(la.normal, ca.normal), {lb.normal, cb.normal}}) {
    const double off_plane_m = std::abs(normal_lidar.dot(lidar_m) - normal_camera.dot(camera_m));
    const double most_m = std::hypot(turned_m, limit_m(normal_lidar, normal_camera));
    error.relative = std::max(error.relative, off_plane_m / most_m);
  }
  return error;
}

// The pairwise comparison of all candidates.
class PairTable {
 public:
  PairTable(const std::vector<BoardSample>& samples,
            const std::vector<Candidate>& candidates,
            const ConsistencyOptions& options)
      : samples_(samples),
        candidates_(candidates),
        options_(options),
        agrees_(candidates.size() * candidates.size(), 0) {
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = i + 1; j < size(); ++j) {
        if (candidates[i].sample == candidates[j].sample) continue;  // one of them at most
        const char agrees = Compare(i, j).Agrees() ? 1 : 0;
        agrees_[i * size() + j] = agrees_[j * size() + i] = agrees;
      }
    }
  }

  std::size_t size() const { return candidates_.size(); }
  bool Agree(std::size_t i, std::size_t j) const { return agrees_[i * size() + j] != 0; }
  const Candidate& candidate(std::size_t i) const { return candidates_[i]; }

  PairError Compare(std::size_t i, std::size_t j) const {
    return ComparePair({Lidar(i), Lidar(j)}, {Camera(i), Camera(j)}, options_);
  }

 private:
  const LidarBoard& Lidar(std::size_t i) const {
    const BoardSample& sample = samples_[candidates_[i].sample];
    const int rank = candidates_[i].rank;
    return rank == 0 ? sample.lidar : sample.runners_up[static_cast<std::size_t>(rank - 1)];
  }
  const BoardPose& Camera(std::size_t i) const {
    return samples_[candidates_[i].sample].camera.pose;
  }

  const std::vector<BoardSample>& samples_;
  const std::vector<Candidate>& candidates_;
  const ConsistencyOptions& options_;
  std::vector<char> agrees_;
};

using Members = std::vector<std::size_t>;  // ascending indices of candidates

// Takes away the worst candidate until all that are left agree.
Members Peel(const PairTable& pairs) {
  Members left(pairs.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<std::size_t> num_agreeing(pairs.size(), 0);
  for (const std::size_t i : left) {
    for (const std::size_t j : left) num_agreeing[i] += pairs.Agree(i, j) ? 1 : 0;
  }
  const auto is_worse = [&](std::size_t i, std::size_t j) {
    if (num_agreeing[i] != num_agreeing[j]) return num_agreeing[i] < num_agreeing[j];
    if (pairs.candidate(i).rank != pairs.candidate(j).rank) {
      return pairs.candidate(i).rank > pairs.candidate(j).rank;
    }
    return i > j;
  };
  while (!left.empty()) {
    const auto worst = std::min_element(left.begin(), left.end(), is_worse);
    if (num_agreeing[*worst] + 1 == left.size()) break;
    for (const std::size_t i : left) num_agreeing[i] -= pairs.Agree(i, *worst) ? 1 : 0;
    left.erase(worst);
  }
  return left;
}

// Gives back what agrees with all members, likeliest candidates first.
Members Grow(Members members, const PairTable& pairs) {
  Members others;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!std::binary_search(members.begin(), members.end(), i)) others.push_back(i);
  }
  std::stable_sort(others.begin(), others.end(), [&](std::size_t i, std::size_t j) {
    return pairs.candidate(i).rank < pairs.candidate(j).rank;
  });
  for (const std::size_t i : others) {
    const auto agrees_with = [&](std::size_t j) { return pairs.Agree(i, j); };
    if (std::all_of(members.begin(), members.end(), agrees_with)) members.push_back(i);
  }
  std::sort(members.begin(), members.end());
  return members;
}

// "disagrees with 28 of 29 consistent samples: ..." with the pair that is farthest off.
std::string ReasonFor(std::size_t candidate,
                      const Members& consistent,
                      const PairTable& pairs,
                      const std::vector<BoardSample>& samples) {
  std::size_t num_disagreeing = 0;
  std::size_t num_others = 0;
  std::size_t worst_sample = 0;
  PairError worst;
  for (const std::size_t i : consistent) {
    if (pairs.candidate(i).sample == pairs.candidate(candidate).sample) continue;
    ++num_others;
    if (!pairs.Agree(candidate, i)) ++num_disagreeing;
    const PairError error = pairs.Compare(candidate, i);
    if (!std::isnan(error.relative) && error.relative <= worst.relative) continue;
    worst = error;
    worst_sample = pairs.candidate(i).sample;
  }
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << "disagrees with " << num_disagreeing << " of " << num_others
       << " consistent samples; worst with sample " << samples[worst_sample].id
       << ": centre distances differ by " << 1000.0 * worst.distance_m << " mm (limit "
       << 1000.0 * worst.max_distance_m << "), normal angles by " << kDegPerRad * worst.angle_rad
       << " deg (limit " << kDegPerRad * worst.max_angle_rad << ")";
  return text.str();
}

}  // namespace

std::vector<std::string> ConsistencyOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("max_distance_m", max_distance_m);
  problems.RequirePositive("max_angle_rad", max_angle_rad);
  return problems.lines();
}

Consistency FindConsistent(const std::vector<BoardSample>& samples,
                           const ConsistencyOptions& options) {
  RequireUsable("ConsistencyOptions", options.Problems());

  Consistency result;
  constexpr std::size_t kLeastToJudge = 3;  // of two that disagree, neither is known to be wrong
  if (samples.size() < kLeastToJudge) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      result.consistent.push_back(static_cast<int>(i));
    return result;
  }
  const std::vector<Candidate> candidates = CandidatesOf(samples);
  const PairTable pairs(samples, candidates, options);
  const Members members = Grow(Peel(pairs), pairs);
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> member_of(samples.size(), kNone);
  for (const std::size_t i : members) member_of[candidates[i].sample] = i;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].rank != 0) continue;  // once a sample, at its likeliest candidate
    const std::size_t member = member_of[candidates[i].sample];
    const int sample = static_cast<int>(candidates[i].sample);
    const auto reason = [&] { return ReasonFor(i, members, pairs, samples); };
    if (member == kNone) {
      result.inconsistent.push_back({sample, reason()});
      continue;
    }
    result.consistent.push_back(sample);
    if (member != i) result.chosen.push_back({sample, candidates[member].rank, reason()});
  }
  return result;
}

void TakeCandidate(int candidate, BoardSample* sample) {
  if (candidate < 1) throw std::out_of_range("no runner-up " + std::to_string(candidate));
  std::swap(sample->lidar, sample->runners_up.at(static_cast<std::size_t>(candidate - 1)));
}

std::vector<BoardSample> ConsistentSamples(const std::vector<BoardSample>& samples,
                                           const Consistency& consistency) {
  std::vector<BoardSample> consistent;
  auto chosen = consistency.chosen.begin();
  for (const int index : consistency.consistent) {
    consistent.push_back(samples[static_cast<std::size_t>(index)]);
    if (chosen == consistency.chosen.end() || chosen->sample != index) continue;
    TakeCandidate(chosen->candidate, &consistent.back());
    ++chosen;
  }
  return consistent;
}

}  // namespace voqcal
