#include "core/board/sample_picker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/geometry/rigid.hpp"

namespace voqcal {
namespace {

// A stream whose partner is silent is judged without it beyond this many frames: memory is bounded.
constexpr std::size_t kMaxWaiting = 600;

std::string Format(const char* before, double value, const char* after) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(std::abs(value) < 10 ? 3 : 1);
  text << before << value << after;
  return text.str();
}

// Why the measured edges cannot be this board's; empty if they can.
std::string EdgeProblem(const LidarBoard& lidar, const BoardSpec& board, double max_edge_error_m) {
  const auto true_lengths_m = board.EdgeLengthsM();
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(lidar.edge_lengths_m[i] - true_lengths_m[i]) <= max_edge_error_m) continue;
    return Format("the lidar measures an edge of ", true_lengths_m[i], " m as ") +
           Format("", lidar.edge_lengths_m[i], " m");
  }
  return {};
}

double LargestCornerMotionPx(const CameraBoard& a, const CameraBoard& b) {
  if (a.corners_px.size() != b.corners_px.size()) return std::numeric_limits<double>::infinity();
  double same_px = 0;
  double turned_px = 0;  // the detector took the other half-turn
  const std::size_t n = a.corners_px.size();
  for (std::size_t i = 0; i < n; ++i) {
    same_px = std::max(same_px, (a.corners_px[i] - b.corners_px[i]).norm());
    turned_px = std::max(turned_px, (a.corners_px[i] - b.corners_px[n - 1 - i]).norm());
  }
  return std::min(same_px, turned_px);
}

// The same board by the half-turn whose x axis is nearer to the reference's.
bool IsTurned(const BoardPose& pose, const BoardPose& reference) {
  const Eigen::Vector3d x = pose.corners_m[1] - pose.corners_m[0];
  const Eigen::Vector3d x_reference = reference.corners_m[1] - reference.corners_m[0];
  return x.dot(x_reference) < 0;
}

// Mean of poses that differ by noise. The covariance stays that of one frame: what it covers beside
// noise (ring offsets, the outline's model, the lens) is the same in every frame of a resting
// board, and averaging does not lessen it.
BoardPose MeanPose(const std::vector<BoardPose>& poses, const BoardSpec& board) {
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Isometry3d T_sensor_board = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();
  const double n = static_cast<double>(poses.size());
  for (const BoardPose& pose : poses) {
    rotations.push_back(TransformFromPose(pose).linear());
    T_sensor_board.translation() += pose.centre_m / n;
    covariance += pose.covariance / n;
  }
  T_sensor_board.linear() = MeanRotation(rotations);
  BoardPose mean = PoseFromTransform(T_sensor_board, board);
  mean.covariance = covariance;
  return mean;
}

LidarBoard MeanLidarBoard(const std::vector<LidarBoard>& boards, const BoardSpec& board) {
  if (boards.size() == 1) return boards.front();
  LidarBoard mean = boards.back();
  const double n = static_cast<double>(boards.size());
  std::vector<BoardPose> poses;
  mean.edge_lengths_m.fill(0);
  double sum_squares_m2 = 0;
  for (const LidarBoard& each : boards) {
    const bool is_turned = IsTurned(each.pose, boards.front().pose);
    poses.push_back(is_turned ? TurnedByHalf(each.pose) : each.pose);
    for (std::size_t i = 0; i < 4; ++i) {
      mean.edge_lengths_m[i] += each.edge_lengths_m[is_turned ? (i + 2) % 4 : i] / n;
    }
    sum_squares_m2 += each.plane_rms_m * each.plane_rms_m;
  }
  mean.pose = MeanPose(poses, board);
  mean.plane_rms_m = std::sqrt(sum_squares_m2 / n);
  return mean;
}

CameraBoard MeanCameraBoard(const std::vector<CameraBoard>& boards, const BoardSpec& board) {
  if (boards.size() == 1) return boards.front();
  CameraBoard mean = boards.front();
  const double n = static_cast<double>(boards.size());
  std::vector<BoardPose> poses;
  std::fill(mean.corners_px.begin(), mean.corners_px.end(), Eigen::Vector2d::Zero());
  double sum_squares_px2 = 0;
  for (const CameraBoard& each : boards) {
    const bool is_turned = IsTurned(each.pose, boards.front().pose);
    poses.push_back(is_turned ? TurnedByHalf(each.pose) : each.pose);
    const std::size_t num_corners = each.corners_px.size();
    for (std::size_t i = 0; i < num_corners; ++i) {
      mean.corners_px[i] += each.corners_px[is_turned ? num_corners - 1 - i : i] / n;
    }
    sum_squares_px2 += each.reprojection_rms_px * each.reprojection_rms_px;
  }
  mean.pose = MeanPose(poses, board);
  mean.reprojection_rms_px = std::sqrt(sum_squares_px2 / n);
  return mean;
}

}  // namespace

std::vector<std::string> SamplePickerOptions::Problems() const {
  std::vector<std::string> problems;
  const auto require = [&problems](bool is_met, const char* rule, double value) {
    if (is_met) return;
    std::ostringstream text;
    text << rule << ", is " << value;
    problems.push_back(text.str());
  };
  require(max_pair_offset_s >= 0, "max_pair_offset_s must not be negative", max_pair_offset_s);
  require(num_still_frames >= 1, "num_still_frames must be at least 1", num_still_frames);
  require(max_still_motion_m > 0, "max_still_motion_m must be positive", max_still_motion_m);
  require(max_still_motion_px > 0, "max_still_motion_px must be positive", max_still_motion_px);
  require(min_new_distance_m >= 0, "min_new_distance_m must not be negative", min_new_distance_m);
  require(min_new_angle_rad >= 0, "min_new_angle_rad must not be negative", min_new_angle_rad);
  require(max_edge_error_m > 0, "max_edge_error_m must be positive", max_edge_error_m);
  return problems;
}

SamplePicker::SamplePicker(const BoardSpec& board, const SamplePickerOptions& options)
    : board_(board),
      options_(options),
      max_pair_offset_us_(std::llround(options.max_pair_offset_s * 1e6)),
      newest_lidar_utime_(std::numeric_limits<std::int64_t>::min()),
      newest_camera_utime_(std::numeric_limits<std::int64_t>::min()) {
  const auto problems = options.Problems();
  if (!problems.empty()) throw std::invalid_argument("SamplePickerOptions: " + problems.front());
}

std::vector<PickerDecision> SamplePicker::Add(const LidarSighting& sighting) {
  if (sighting.utime <= newest_lidar_utime_) {
    return {{sighting.utime, {}, "lidar frame out of order"}};
  }
  newest_lidar_utime_ = sighting.utime;
  lidar_.push_back(sighting);
  return Judge(false);
}

std::vector<PickerDecision> SamplePicker::Add(const CameraSighting& sighting) {
  if (sighting.utime <= newest_camera_utime_) {
    return {{sighting.utime, {}, "camera frame out of order"}};
  }
  newest_camera_utime_ = sighting.utime;
  camera_.push_back(sighting);
  return Judge(false);
}

std::vector<PickerDecision> SamplePicker::Flush() { return Judge(true); }

void SamplePicker::SetKnown(const std::vector<BoardSample>& samples) {
  known_T_camera_board_.clear();
  for (const BoardSample& sample : samples) {
    known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
  }
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

PickerDecision SamplePicker::JudgePair(const Pair& pair) {
  const auto reject = [this, &pair](const std::string& reason, const std::string& detail = "") {
    window_.clear();
    return PickerDecision{pair.lidar.utime, {}, reason, detail};
  };
  if (!pair.lidar.board) return reject("lidar: " + pair.lidar.miss);
  if (!pair.camera.board) return reject("camera: " + pair.camera.miss);
  const std::string edge_problem =
      EdgeProblem(*pair.lidar.board, board_, options_.max_edge_error_m);
  if (!edge_problem.empty()) return reject("wrong board size", edge_problem);

  if (is_capture_requested_) {
    is_capture_requested_ = false;
    window_.clear();
    BoardSample sample =
        AverageSightings({*pair.lidar.board}, {*pair.camera.board}, pair.lidar.utime, board_);
    sample.camera_utime = pair.camera.utime;
    known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
    return {pair.lidar.utime, std::move(sample), {}};
  }

  const std::string motion = Motion(pair);
  if (!motion.empty()) window_.clear();
  window_.push_back(pair);
  if (static_cast<int>(window_.size()) < options_.num_still_frames) {
    return {pair.lidar.utime, {}, motion.empty() ? "not yet still for long enough" : motion};
  }
  return JudgeWindow();
}

std::string SamplePicker::Motion(const Pair& pair) const {
  for (const Pair& earlier : window_) {
    const double motion_m =
        (pair.lidar.board->pose.centre_m - earlier.lidar.board->pose.centre_m).norm();
    if (motion_m > options_.max_still_motion_m) return "board is moving";
    if (LargestCornerMotionPx(*pair.camera.board, *earlier.camera.board) >
        options_.max_still_motion_px) {
      return "board is moving";
    }
  }
  return {};
}

PickerDecision SamplePicker::JudgeWindow() {
  std::vector<LidarBoard> lidar;
  std::vector<CameraBoard> camera;
  for (const Pair& pair : window_) {
    lidar.push_back(*pair.lidar.board);
    camera.push_back(*pair.camera.board);
  }
  const std::int64_t utime = window_.front().lidar.utime;
  const std::int64_t camera_utime = window_.front().camera.utime;
  window_.erase(window_.begin());  // the next pair may complete a new window
  BoardSample sample = AverageSightings(lidar, camera, utime, board_);
  sample.camera_utime = camera_utime;
  if (!IsNew(sample)) return {utime, {}, "pose is not new"};
  known_T_camera_board_.push_back(TransformFromPose(sample.camera.pose));
  return {utime, std::move(sample), {}};
}

bool SamplePicker::IsNew(const BoardSample& sample) const {
  const Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
  const Eigen::Isometry3d T_turned = TransformFromPose(TurnedByHalf(sample.camera.pose));
  return std::none_of(
      known_T_camera_board_.begin(), known_T_camera_board_.end(), [&](const auto& T_known) {
        const double distance_m = (T_known.translation() - T_camera_board.translation()).norm();
        const double angle_rad =
            std::min(RotationAngleBetween(T_known.linear(), T_camera_board.linear()),
                     RotationAngleBetween(T_known.linear(), T_turned.linear()));
        return distance_m < options_.min_new_distance_m && angle_rad < options_.min_new_angle_rad;
      });
}

BoardSample AverageSightings(const std::vector<LidarBoard>& lidar,
                             const std::vector<CameraBoard>& camera,
                             std::int64_t utime,
                             const BoardSpec& board) {
  if (lidar.empty() || lidar.size() != camera.size()) {
    throw std::invalid_argument("AverageSightings: " + std::to_string(lidar.size()) +
                                " lidar and " + std::to_string(camera.size()) + " camera frames");
  }
  BoardSample sample;
  sample.utime = utime;
  sample.num_frames = static_cast<int>(lidar.size());
  sample.lidar = MeanLidarBoard(lidar, board);
  sample.camera = MeanCameraBoard(camera, board);
  return sample;
}

}  // namespace voqcal
