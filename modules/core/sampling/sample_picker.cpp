#include "core/sampling/sample_picker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/format.hpp"
#include "core/geometry/rigid.hpp"
#include "core/problems.hpp"
#include "core/sampling/average_sightings.hpp"
#include "core/sampling/corner_motion.hpp"

namespace voqcal {
namespace {

// A stream whose partner is silent is judged without it beyond this many frames: memory is bounded.
constexpr std::size_t kMaxWaiting = 600;

// Why the measured edges cannot be this board's; empty if they can. An edge that was not measured
// (NaN) speaks against nothing.
std::string EdgeProblem(const LidarBoard& lidar, const BoardSpec& board, double max_edge_error_m) {
  const auto true_lengths_m = board.EdgeLengthsM();
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(std::abs(lidar.edge_lengths_m[i] - true_lengths_m[i]) > max_edge_error_m)) continue;
    return Format("the lidar measures an edge of %.3f m as %.3f m",
                  true_lengths_m[i],
                  lidar.edge_lengths_m[i]);
  }
  return {};
}

std::vector<PickerDecision> Joined(std::vector<PickerDecision> first,
                                   const std::vector<PickerDecision>& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

std::vector<LidarBoard> CandidatesOf(const LidarSighting& sighting) {
  std::vector<LidarBoard> candidates = sighting.runners_up;
  candidates.insert(candidates.begin(), *sighting.board);
  return candidates;
}

// Leaves only the candidates that can be this board. @return why the first cannot, if none is left.
std::string DropWrongSizes(const BoardSpec& board, double max_edge_error_m, LidarSighting* lidar) {
  std::vector<LidarBoard> candidates = CandidatesOf(*lidar);
  const std::string problem = EdgeProblem(candidates.front(), board, max_edge_error_m);
  candidates.erase(std::remove_if(candidates.begin(),
                                  candidates.end(),
                                  [&](const LidarBoard& candidate) {
                                    return !EdgeProblem(candidate, board, max_edge_error_m).empty();
                                  }),
                   candidates.end());
  if (candidates.empty()) return problem;
  lidar->board = candidates.front();
  lidar->runners_up.assign(candidates.begin() + 1, candidates.end());
  return {};
}

// The candidate of that frame whose centre is nearest; null if none lies within reach.
const LidarBoard* FoundAgain(const LidarBoard& board, const LidarSighting& frame, double reach_m) {
  const LidarBoard* nearest = nullptr;
  const auto consider = [&](const LidarBoard& candidate) {
    const double distance_m = (candidate.pose.centre_m - board.pose.centre_m).norm();
    if (distance_m > reach_m) return;
    reach_m = distance_m;
    nearest = &candidate;
  };
  for (const LidarBoard& candidate : frame.runners_up) consider(candidate);
  consider(*frame.board);
  return nearest;
}

// The pose is none of the known ones, up to the board's half-turn.
bool IsNewAmong(const std::vector<Eigen::Isometry3d>& known_T_camera_board,
                const BoardPose& pose_camera,
                const SamplePickerOptions& options) {
  const Eigen::Isometry3d T_camera_board = TransformFromPose(pose_camera);
  const Eigen::Isometry3d T_turned = TransformFromPose(TurnedByHalf(pose_camera));
  return std::none_of(
      known_T_camera_board.begin(), known_T_camera_board.end(), [&](const auto& T_known) {
        const double distance_m = (T_known.translation() - T_camera_board.translation()).norm();
        const double angle_rad =
            std::min(RotationAngleBetween(T_known.linear(), T_camera_board.linear()),
                     RotationAngleBetween(T_known.linear(), T_turned.linear()));
        return distance_m < options.min_new_distance_m && angle_rad < options.min_new_angle_rad;
      });
}

}  // namespace

std::vector<std::string> SamplePickerOptions::Problems() const {
  ProblemList problems;
  problems.Require(
      max_pair_offset_s >= 0, "max_pair_offset_s must not be negative", max_pair_offset_s);
  problems.Require(num_still_frames >= 1, "num_still_frames must be at least 1", num_still_frames);
  problems.RequirePositive("max_still_motion_m", max_still_motion_m);
  problems.RequirePositive("max_still_motion_px", max_still_motion_px);
  problems.Require(
      min_new_distance_m >= 0, "min_new_distance_m must not be negative", min_new_distance_m);
  problems.Require(
      min_new_angle_rad >= 0, "min_new_angle_rad must not be negative", min_new_angle_rad);
  problems.RequirePositive("max_edge_error_m", max_edge_error_m);
  problems.Require(max_candidates >= 1, "max_candidates must be at least 1", max_candidates);
  return problems.lines();
}

SamplePicker::SamplePicker(const BoardSpec& board, const SamplePickerOptions& options)
    : board_(board),
      options_(options),
      max_pair_offset_us_(std::llround(options.max_pair_offset_s * 1e6)),
      newest_lidar_utime_(std::numeric_limits<std::int64_t>::min()),
      newest_camera_utime_(std::numeric_limits<std::int64_t>::min()) {
  RequireUsable("SamplePickerOptions", options.Problems());
}

std::vector<PickerDecision> SamplePicker::Add(const LidarSighting& sighting) {
  std::vector<PickerDecision> decisions = RestartIfBack(sighting.utime, newest_lidar_utime_);
  if (sighting.utime <= newest_lidar_utime_) {
    decisions.push_back({sighting.utime, {}, "lidar frame out of order"});
    return decisions;
  }
  newest_lidar_utime_ = sighting.utime;
  lidar_.push_back(sighting);
  return Joined(std::move(decisions), Judge(false));
}

std::vector<PickerDecision> SamplePicker::Add(const CameraSighting& sighting) {
  std::vector<PickerDecision> decisions = RestartIfBack(sighting.utime, newest_camera_utime_);
  if (sighting.utime <= newest_camera_utime_) {
    decisions.push_back({sighting.utime, {}, "camera frame out of order"});
    return decisions;
  }
  newest_camera_utime_ = sighting.utime;
  camera_.push_back(sighting);
  return Joined(std::move(decisions), Judge(false));
}

// A driver that was started again on a folder or a capture, or a clock that was set: what waits is
// judged, and time begins anew for both sensors.
std::vector<PickerDecision> SamplePicker::RestartIfBack(std::int64_t utime, std::int64_t newest) {
  constexpr double kMaxOutOfOrderUs = 2e6;  // networks reorder by less
  if (static_cast<double>(newest) - static_cast<double>(utime) <= kMaxOutOfOrderUs) return {};
  std::vector<PickerDecision> decisions = Judge(true);
  ForgetWaiting();
  newest_lidar_utime_ = newest_camera_utime_ = std::numeric_limits<std::int64_t>::min();
  return decisions;
}

std::vector<PickerDecision> SamplePicker::Flush() { return Judge(true); }

FramesInUse SamplePicker::InUse() const {
  FramesInUse frames;
  for (const LidarSighting& lidar : lidar_) frames.lidar_utimes.push_back(lidar.utime);
  for (const CameraSighting& camera : camera_) frames.camera_utimes.push_back(camera.utime);
  for (const std::vector<Pair>* pairs : {&window_, &followed_}) {
    for (const Pair& pair : *pairs) {
      frames.lidar_utimes.push_back(pair.lidar.utime);
      frames.camera_utimes.push_back(pair.camera.utime);
    }
  }
  return frames;
}

void SamplePicker::SetKnown(const std::vector<BoardSample>& samples) {
  known_T_camera_board_.clear();
  for (const BoardSample& sample : samples) {
    known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
  }
}

void SamplePicker::StartAnew() {
  ForgetWaiting();
  known_T_camera_board_.clear();
  unsure_T_camera_board_.clear();
}

void SamplePicker::ForgetWaiting() {
  lidar_.clear();
  camera_.clear();
  window_.clear();
  followed_.clear();
  rest_begin_.reset();
}

int SamplePicker::NearestCameraFrame(std::int64_t utime) const {
  int nearest = -1;
  std::int64_t least_us = max_pair_offset_us_ + 1;
  for (std::size_t i = 0; i < camera_.size(); ++i) {
    const std::int64_t offset_us = std::abs(camera_[i].utime - utime);
    if (offset_us >= least_us) continue;
    least_us = offset_us;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

std::vector<PickerDecision> SamplePicker::Judge(bool is_flushing) {
  std::vector<PickerDecision> decisions;
  while (!lidar_.empty()) {
    const bool has_camera_passed =
        newest_camera_utime_ >= lidar_.front().utime + max_pair_offset_us_;
    if (!has_camera_passed && !is_flushing && lidar_.size() <= kMaxWaiting) break;
    const LidarSighting lidar = lidar_.front();
    lidar_.pop_front();
    const int partner = NearestCameraFrame(lidar.utime);
    if (partner < 0) {
      decisions.push_back({lidar.utime, {}, "no camera frame at that time"});
      continue;
    }
    // Camera frames before the partner can have no lidar frame any more.
    for (int i = 0; i < partner; ++i) decisions.push_back(DropCameraFrame());
    const CameraSighting camera = camera_.front();
    camera_.pop_front();
    decisions.push_back(JudgePair({lidar, camera}));
  }
  // What no lidar frame can claim: those that are waiting, or still to come, are too late for it.
  while (!camera_.empty()) {
    const std::int64_t next_lidar_utime =
        lidar_.empty() ? newest_lidar_utime_ : lidar_.front().utime;
    const bool is_unclaimed = camera_.front().utime + max_pair_offset_us_ < next_lidar_utime;
    if (!is_unclaimed && !is_flushing && camera_.size() <= kMaxWaiting) break;
    decisions.push_back(DropCameraFrame());
  }
  return decisions;
}

PickerDecision SamplePicker::DropCameraFrame() {
  const std::int64_t utime = camera_.front().utime;
  camera_.pop_front();
  return {utime, {}, "no lidar frame at that time"};
}

PickerDecision SamplePicker::JudgePair(Pair pair) {
  const auto reject = [this, &pair](const std::string& reason, const std::string& detail = "") {
    window_.clear();
    return PickerDecision{pair.lidar.utime, {}, reason, detail};
  };
  FollowCamera(pair);
  if (!pair.lidar.board) {
    PickerDecision decision = reject("lidar: " + pair.lidar.miss);
    decision.unsure = FollowedStop();
    return decision;
  }
  if (!pair.camera.board) return reject("camera: " + pair.camera.miss);
  const std::string edge_problem = DropWrongSizes(board_, options_.max_edge_error_m, &pair.lidar);
  if (!edge_problem.empty()) return reject("wrong board size", edge_problem);

  if (is_capture_requested_) {
    is_capture_requested_ = false;
    window_.clear();
    BoardSample sample =
        MakeSample(CandidatesOf(pair.lidar), {*pair.camera.board}, pair.lidar.utime);
    sample.camera_utime = pair.camera.utime;
    known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
    return {pair.lidar.utime, std::move(sample), {}};
  }

  if (!HasRestedThrough(pair.lidar)) return reject("not yet still for long enough");
  const std::string motion = Motion(pair);
  if (!motion.empty()) window_.clear();
  window_.push_back(pair);
  if (static_cast<int>(window_.size()) < options_.num_still_frames) {
    return {pair.lidar.utime, {}, motion.empty() ? "not yet still for long enough" : motion};
  }
  PickerDecision decision = JudgeWindow(window_);
  window_.erase(window_.begin());  // the next pair may complete a new window
  return decision;
}

PickerDecision SamplePicker::TakeStop(const UnsureStop& stop) {
  std::vector<Pair> window;
  for (std::size_t i = 0; i < stop.lidar.size(); ++i) {
    window.push_back({stop.lidar[i], stop.camera[i]});
  }
  ForgetUnsure(stop.camera.front().board->pose);
  return JudgeWindow(window);
}

void SamplePicker::FollowCamera(const Pair& pair) {
  const auto has_moved_since = [this, &pair](const CameraSighting& earlier) {
    return LargestCornerMotionPx(*pair.camera.board, *earlier.board) > options_.max_still_motion_px;
  };
  const bool has_moved = !pair.camera.board ||
                         std::any_of(followed_.begin(), followed_.end(), [&](const Pair& earlier) {
                           return has_moved_since(earlier.camera);
                         });
  if (has_moved) followed_.clear();
  if (has_moved || (rest_begin_ && has_moved_since(*rest_begin_))) rest_begin_.reset();
  if (!pair.camera.board) return;
  if (!rest_begin_) rest_begin_ = pair.camera;
  followed_.push_back(pair);
  if (static_cast<int>(followed_.size()) > options_.num_still_frames) {
    followed_.erase(followed_.begin());
  }
}

bool SamplePicker::HasRestedThrough(const LidarSighting& lidar) const {
  return lidar.utime - lidar.accumulated_us + max_pair_offset_us_ >= rest_begin_->utime;
}

// What the newest frame ranks first must have been there before, whatever its rank was then.
std::string SamplePicker::Motion(const Pair& pair) const {
  for (const Pair& earlier : window_) {
    const bool is_found =
        FoundAgain(*pair.lidar.board, earlier.lidar, options_.max_still_motion_m) != nullptr;
    if (!is_found || LargestCornerMotionPx(*pair.camera.board, *earlier.camera.board) >
                         options_.max_still_motion_px) {
      return "board is moving";
    }
  }
  return {};
}

std::vector<LidarBoard> SamplePicker::RestingCandidates(const std::vector<Pair>& window) const {
  std::vector<LidarBoard> resting;
  for (const LidarBoard& candidate : CandidatesOf(window.back().lidar)) {
    std::vector<LidarBoard> track;
    for (const Pair& pair : window) {
      const LidarBoard* found = FoundAgain(candidate, pair.lidar, options_.max_still_motion_m);
      if (found != nullptr) track.push_back(*found);
    }
    if (track.size() == window.size()) resting.push_back(MeanLidarBoard(track, board_));
  }
  std::stable_sort(resting.begin(), resting.end(), [](const LidarBoard& a, const LidarBoard& b) {
    return a.log_likelihood > b.log_likelihood;
  });
  return resting;
}

BoardSample SamplePicker::MakeSample(std::vector<LidarBoard> candidates,
                                     const std::vector<CameraBoard>& camera,
                                     std::int64_t utime) const {
  const auto num_kept =
      std::min(candidates.size(), static_cast<std::size_t>(options_.max_candidates));
  BoardSample sample;
  sample.utime = utime;
  sample.num_frames = static_cast<int>(camera.size());
  sample.camera = MeanCameraBoard(camera, board_);
  sample.lidar = candidates.front();
  sample.runners_up.assign(candidates.begin() + 1,
                           candidates.begin() + static_cast<std::ptrdiff_t>(num_kept));
  return sample;
}

PickerDecision SamplePicker::JudgeWindow(const std::vector<Pair>& window) {
  std::vector<CameraBoard> camera;
  for (const Pair& pair : window) camera.push_back(*pair.camera.board);
  const std::int64_t utime = window.front().lidar.utime;
  std::vector<LidarBoard> candidates = RestingCandidates(window);
  if (candidates.empty()) return {utime, {}, "board is moving"};
  BoardSample sample = MakeSample(std::move(candidates), camera, utime);
  sample.camera_utime = window.front().camera.utime;
  if (!IsNew(sample.camera.pose)) return {utime, {}, "pose is not new"};
  known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
  return {utime, std::move(sample), {}};
}

// What has been followed for long enough, at a place that no sample and no earlier stop has.
std::optional<UnsureStop> SamplePicker::FollowedStop() {
  if (static_cast<int>(followed_.size()) < options_.num_still_frames) return {};
  const BoardPose& pose = followed_.front().camera.board->pose;
  if (!IsNew(pose) || !IsNewAmong(unsure_T_camera_board_, pose, options_)) return {};
  unsure_T_camera_board_.push_back(TransformFromPose(pose));
  UnsureStop stop;
  for (const Pair& pair : followed_) {
    stop.lidar.push_back(pair.lidar);
    stop.camera.push_back(pair.camera);
  }
  return stop;
}

void SamplePicker::ForgetUnsure(const BoardPose& pose_camera) {
  const Eigen::Isometry3d T_camera_board = TransformFromPose(pose_camera);
  auto& unsure = unsure_T_camera_board_;
  const auto is_that = [&](const Eigen::Isometry3d& T) {
    return T.matrix() == T_camera_board.matrix();
  };
  unsure.erase(std::remove_if(unsure.begin(), unsure.end(), is_that), unsure.end());
}

bool SamplePicker::IsNew(const BoardPose& pose_camera) const {
  return IsNewAmong(known_T_camera_board_, pose_camera, options_);
}

}  // namespace voqcal
