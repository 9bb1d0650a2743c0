#include "core/selection/extrinsic_vote.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/estimation/pose_fit.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kLeastVotes = 4;
constexpr std::size_t kLeastSureVotes = 3;
constexpr std::size_t kLeastVotesForGuess = 2;
constexpr double kMaxSquaredSigmas = 20.0;  // of six dimensions: 0.27 % of right ones are farther
// Beside the detectors' noise: ranges that are all off, a board that moves between the two sensors'
// times. (1 sigma)
constexpr double kModelErrorRad = 0.02;
constexpr double kModelErrorM = 0.02;
constexpr double kGuessErrorRad = 0.05;
constexpr double kGuessErrorM = 0.1;

Matrix6d SquaresOf(double rotation_rad, double translation_m) {
  Vector6d squares;
  squares << Eigen::Vector3d::Constant(rotation_rad * rotation_rad),
      Eigen::Vector3d::Constant(translation_m * translation_m);
  return squares.asDiagonal();
}

// One candidate of one stop.
struct Ballot {
  std::size_t stop = 0;
  BoardSample sample;  // without points and runners-up
};

std::vector<Ballot> BallotsOf(const std::vector<BoardSample>& stops) {
  std::vector<Ballot> ballots;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto add = [&](const LidarBoard& lidar) {
      if (!lidar.pose.centre_m.allFinite()) return;  // a stop without any candidate
      Ballot ballot;
      ballot.stop = i;
      ballot.sample.camera = stops[i].camera;
      ballot.sample.lidar.pose = lidar.pose;
      ballot.sample.lidar.sides = lidar.sides;
      ballots.push_back(std::move(ballot));
    };
    add(stops[i].lidar);
    for (const LidarBoard& other : stops[i].runners_up) add(other);
  }
  return ballots;
}

// Its pose alone makes an extrinsic: neither centre nor turn is open.
bool FixesExtrinsic(const Ballot& ballot) {
  constexpr double kMaxTurnRad = 0.15;
  const BoardPose& pose = ballot.sample.lidar.pose;
  const double turn2_rad2 = pose.normal.dot(pose.covariance.topLeftCorner<3, 3>() * pose.normal);
  return IsCentreMeasured(ballot.sample.lidar) && turn2_rad2 <= kMaxTurnRad * kMaxTurnRad;
}

PoseDifference WithModelError(const Ballot& ballot,
                              const CameraModel& camera,
                              const Eigen::Isometry3d& T_camera_lidar) {
  PoseDifference difference = DifferenceOf(ballot.sample, camera, T_camera_lidar, {});
  difference.C += SquaresOf(kModelErrorRad, kModelErrorM);
  return difference;
}

// The extrinsic that puts this candidate, turned so, where the camera sees the board.
RoughExtrinsic ExtrinsicBy(const Ballot& ballot, int num_quarters, const CameraModel& camera) {
  RoughExtrinsic rough;
  const BoardPose turned = TurnedByQuarters(ballot.sample.lidar.pose, num_quarters);
  rough.T_camera_lidar =
      TransformFromPose(ballot.sample.camera.pose) * TransformFromPose(turned).inverse();
  const PoseDifference difference = WithModelError(ballot, camera, rough.T_camera_lidar);
  const Matrix6d J_inverse = difference.J.inverse();
  rough.covariance = J_inverse * difference.C * J_inverse.transpose();
  return rough;
}

// Those who agree with an extrinsic: at most one candidate of each stop.
struct Votes {
  std::vector<const BoardSample*> samples;
  std::size_t num_sure = 0;
  double sum_squared_sigmas = 0.0;

  bool AreEnough() const { return samples.size() >= kLeastVotes || num_sure >= kLeastSureVotes; }

  bool operator<(const Votes& other) const {
    if (samples.size() != other.samples.size()) return samples.size() < other.samples.size();
    return sum_squared_sigmas > other.sum_squared_sigmas;
  }
};

Votes VotesFor(const RoughExtrinsic& rough,
               const std::vector<Ballot>& ballots,
               std::size_t num_sure,
               const CameraModel& camera) {
  Votes votes;
  for (std::size_t i = 0; i < ballots.size();) {
    const std::size_t stop = ballots[i].stop;
    const BoardSample* nearest = nullptr;
    double least = kMaxSquaredSigmas;
    for (; i < ballots.size() && ballots[i].stop == stop; ++i) {
      PoseDifference difference = WithModelError(ballots[i], camera, rough.T_camera_lidar);
      difference.C += difference.J * rough.covariance * difference.J.transpose();
      const double squared = difference.SquaredSigmas();
      if (!(squared < least)) continue;
      least = squared;
      nearest = &ballots[i].sample;
    }
    if (nearest == nullptr) continue;
    votes.samples.push_back(nearest);
    if (stop < num_sure) ++votes.num_sure;
    votes.sum_squared_sigmas += least;
  }
  return votes;
}

// Every extrinsic that is to be voted on; of very many ballots every n-th makes one.
std::vector<RoughExtrinsic> Hypotheses(const std::vector<Ballot>& ballots,
                                       const CameraModel& camera) {
  constexpr std::size_t kMostMakers = 200;
  const std::size_t step = 1 + ballots.size() / kMostMakers;
  std::vector<RoughExtrinsic> hypotheses;
  for (std::size_t i = 0; i < ballots.size(); i += step) {
    if (!FixesExtrinsic(ballots[i])) continue;
    const auto& c = ballots[i].sample.lidar.pose.corners_m;
    const int quarters = IsSquare((c[1] - c[0]).norm(), (c[2] - c[1]).norm()) ? 1 : 2;
    for (int turn = 0; turn < 4; turn += quarters) {
      hypotheses.push_back(ExtrinsicBy(ballots[i], turn, camera));
    }
  }
  return hypotheses;
}

}  // namespace

std::optional<RoughExtrinsic> VoteForExtrinsic(const std::vector<BoardSample>& stops,
                                               std::size_t num_sure,
                                               const CameraModel& camera,
                                               const std::optional<Eigen::Isometry3d>& guess) {
  constexpr int kRounds = 3;
  const std::vector<Ballot> ballots = BallotsOf(stops);
  RoughExtrinsic best;
  Votes votes;
  for (const RoughExtrinsic& hypothesis : Hypotheses(ballots, camera)) {
    Votes its_votes = VotesFor(hypothesis, ballots, num_sure, camera);
    if (!(votes < its_votes)) continue;
    votes = std::move(its_votes);
    best = hypothesis;
  }
  const bool is_by_guess = guess && !votes.AreEnough();
  if (is_by_guess) {
    best = {*guess, SquaresOf(kGuessErrorRad, kGuessErrorM), 0};
    votes = VotesFor(best, ballots, num_sure, camera);
  }
  const auto are_enough = [&votes, is_by_guess] {
    return votes.AreEnough() || (is_by_guess && votes.samples.size() >= kLeastVotesForGuess);
  };
  // What all who agree say together brings others in, and leaves out who agreed by chance.
  for (int round = 0; round < kRounds && are_enough(); ++round) {
    const PoseFit fit = FitPoses(votes.samples, camera, best.T_camera_lidar, {});
    if (!fit.is_usable) break;
    best = {fit.T_camera_lidar, fit.covariance, 0};
    votes = VotesFor(best, ballots, num_sure, camera);
  }
  best.num_agreeing = static_cast<int>(votes.samples.size());
  if (are_enough()) return best;
  if (!guess) return {};
  return RoughExtrinsic{*guess, SquaresOf(kGuessErrorRad, kGuessErrorM), 0};
}

ExpectedBoard ExpectBoard(const BoardPose& pose_camera, const RoughExtrinsic& extrinsic) {
  ExpectedBoard expected;
  const Eigen::Isometry3d& T = extrinsic.T_camera_lidar;
  expected.T_lidar_board = T.inverse() * TransformFromPose(pose_camera);
  Matrix6d J = Matrix6d::Identity();
  J.bottomLeftCorner<3, 3>() = -Skew(pose_camera.centre_m - T.translation());
  const Matrix6d in_camera_axes = pose_camera.covariance +
                                  J * extrinsic.covariance * J.transpose() +
                                  SquaresOf(kModelErrorRad, kModelErrorM);
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = T.linear().transpose();
  A.bottomRightCorner<3, 3>() = T.linear().transpose();
  expected.covariance = A * in_camera_axes * A.transpose();
  return expected;
}

}  // namespace voqcal
