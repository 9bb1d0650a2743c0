#include "messaging/convert_board.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "messaging/message_error.hpp"
#include "messaging/row_major.hpp"

namespace voqcal {
namespace {

/// A cloud without intensity is not one of intensity 0.
constexpr float kNoIntensity = std::numeric_limits<float>::quiet_NaN();

void CopyPoints(const PointCloud& cloud_lidar_m, lidar_candidate_t* message) {
  for (const LidarPoint& point : cloud_lidar_m.points) {
    const float intensity = cloud_lidar_m.has_intensity ? point.intensity : kNoIntensity;
    const Eigen::Vector3f& p = point.position_m;
    message->points.push_back({p.x(), p.y(), p.z(), intensity});
    if (cloud_lidar_m.has_ring) message->rings.push_back(static_cast<std::int16_t>(point.ring));
  }
  message->num_points = static_cast<std::int32_t>(message->points.size());
  message->num_rings = static_cast<std::int32_t>(message->rings.size());
}

PointCloud PointsOf(const lidar_candidate_t& message) {
  if (!message.rings.empty() && message.rings.size() != message.points.size()) {
    throw MessageError("lidar board message: " + std::to_string(message.points.size()) +
                       " points but " + std::to_string(message.rings.size()) + " rings");
  }
  PointCloud cloud;
  cloud.has_ring = !message.rings.empty();
  cloud.has_intensity = std::any_of(message.points.begin(),
                                    message.points.end(),
                                    [](const auto& point) { return !std::isnan(point[3]); });
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    LidarPoint point;
    point.position_m = Eigen::Map<const Eigen::Vector3f>(message.points[i].data());
    if (cloud.has_intensity) point.intensity = message.points[i][3];
    if (cloud.has_ring) point.ring = static_cast<std::uint16_t>(message.rings[i]);
    cloud.points.push_back(point);
  }
  return cloud;
}

SideView ViewOf(std::int8_t code) {
  if (code < 0 || code > static_cast<std::int8_t>(SideView::kGap)) {
    throw MessageError("lidar board message: side " + std::to_string(code) + " is none of 0 to 4");
  }
  return static_cast<SideView>(code);
}

}  // namespace

board_pose_t ToMessage(const BoardPose& pose) {
  board_pose_t message{};
  Eigen::Map<Eigen::Vector3d>(message.centre_m) = pose.centre_m;
  Eigen::Map<Eigen::Vector3d>(message.normal) = pose.normal;
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Map<Eigen::Vector3d>(message.corners_m[i]) = pose.corners_m[i];
  }
  Eigen::Map<RowMajor6d>(&message.covariance[0][0]) = pose.covariance;
  return message;
}

BoardPose FromMessage(const board_pose_t& message) {
  BoardPose pose;
  pose.centre_m = Eigen::Map<const Eigen::Vector3d>(message.centre_m);
  pose.normal = Eigen::Map<const Eigen::Vector3d>(message.normal);
  for (std::size_t i = 0; i < 4; ++i) {
    pose.corners_m[i] = Eigen::Map<const Eigen::Vector3d>(message.corners_m[i]);
  }
  pose.covariance = Eigen::Map<const RowMajor6d>(&message.covariance[0][0]);
  return pose;
}

lidar_candidate_t ToMessage(const LidarBoard& board) {
  lidar_candidate_t message{};
  message.pose = ToMessage(board.pose);
  std::transform(board.sides.begin(), board.sides.end(), message.sides, [](SideView view) {
    return static_cast<std::int8_t>(view);
  });
  std::copy(board.edge_lengths_m.begin(), board.edge_lengths_m.end(), message.edge_lengths_m);
  message.plane_rms_m = board.plane_rms_m;
  message.num_beams = board.num_beams;
  message.log_likelihood = board.log_likelihood;
  CopyPoints(board.points_lidar_m, &message);
  return message;
}

LidarBoard FromMessage(const lidar_candidate_t& message) {
  LidarBoard board;
  board.pose = FromMessage(message.pose);
  std::transform(std::begin(message.sides), std::end(message.sides), board.sides.begin(), ViewOf);
  std::copy(std::begin(message.edge_lengths_m),
            std::end(message.edge_lengths_m),
            board.edge_lengths_m.begin());
  board.plane_rms_m = message.plane_rms_m;
  board.num_beams = message.num_beams;
  board.log_likelihood = message.log_likelihood;
  board.points_lidar_m = PointsOf(message);
  return board;
}

camera_board_t ToMessage(const CameraBoard& board) {
  camera_board_t message{};
  message.frame = "camera";
  message.pose = ToMessage(board.pose);
  message.reprojection_rms_px = board.reprojection_rms_px;
  for (const Eigen::Vector2d& corner_px : board.corners_px) {
    message.corners_px.push_back({corner_px.x(), corner_px.y()});
  }
  message.num_corners = static_cast<std::int32_t>(message.corners_px.size());
  for (const SightingWarning& warning : board.warnings) {
    message.warnings.emplace_back();
    message.warnings.back().reason = warning.reason;
    message.warnings.back().detail = warning.detail;
  }
  message.num_warnings = static_cast<std::int32_t>(message.warnings.size());
  return message;
}

CameraBoard FromMessage(const camera_board_t& message) {
  CameraBoard board;
  board.pose = FromMessage(message.pose);
  board.reprojection_rms_px = message.reprojection_rms_px;
  for (const auto& corner_px : message.corners_px) {
    board.corners_px.emplace_back(corner_px[0], corner_px[1]);
  }
  for (const warning_t& warning : message.warnings) {
    board.warnings.push_back({warning.reason, warning.detail});
  }
  return board;
}

lidar_board_t LidarBoardMessage(const std::vector<LidarBoard>& candidates,
                                const std::string& miss,
                                std::int64_t utime,
                                std::int64_t accumulated_us,
                                std::int64_t seq) {
  lidar_board_t message{};
  message.utime = utime;
  message.accumulated_us = accumulated_us;
  message.seq = seq;
  message.frame = "lidar";
  message.miss = miss;
  for (const LidarBoard& candidate : candidates) message.candidates.push_back(ToMessage(candidate));
  message.num_candidates = static_cast<std::int32_t>(message.candidates.size());
  return message;
}

camera_board_t CameraBoardMessage(const std::optional<CameraBoard>& board,
                                  const std::string& miss,
                                  const std::string& detail,
                                  std::int64_t utime,
                                  std::int64_t seq) {
  camera_board_t message = ToMessage(board.value_or(CameraBoard{}));
  message.utime = utime;
  message.seq = seq;
  message.miss = miss;
  message.detail = detail;
  return message;
}

LidarSighting SightingFromMessage(const lidar_board_t& message) {
  LidarSighting sighting;
  sighting.utime = message.utime;
  sighting.accumulated_us = message.accumulated_us;
  sighting.miss = message.miss;
  for (const lidar_candidate_t& candidate : message.candidates) {
    if (!message.miss.empty()) {
      sighting.unsure.push_back(FromMessage(candidate));
    } else if (sighting.board) {
      sighting.runners_up.push_back(FromMessage(candidate));
    } else {
      sighting.board = FromMessage(candidate);
    }
  }
  return sighting;
}

CameraSighting SightingFromMessage(const camera_board_t& message) {
  CameraSighting sighting;
  sighting.utime = message.utime;
  sighting.miss = message.miss;
  if (message.miss.empty()) sighting.board = FromMessage(message);
  return sighting;
}

sample_t ToMessage(const BoardSample& sample) {
  sample_t message{};
  message.id = sample.id;
  message.utime = sample.utime;
  message.num_frames = sample.num_frames;
  message.lidar = ToMessage(sample.lidar);
  message.camera = ToMessage(sample.camera);
  message.camera.utime = sample.camera_utime;
  for (const LidarBoard& other : sample.runners_up) message.runners_up.push_back(ToMessage(other));
  message.num_runners_up = static_cast<std::int32_t>(message.runners_up.size());
  return message;
}

BoardSample FromMessage(const sample_t& message) {
  BoardSample sample;
  sample.id = message.id;
  sample.utime = message.utime;
  sample.num_frames = message.num_frames;
  sample.lidar = FromMessage(message.lidar);
  sample.camera = FromMessage(message.camera);
  sample.camera_utime = message.camera.utime;
  for (const lidar_candidate_t& other : message.runners_up) {
    sample.runners_up.push_back(FromMessage(other));
  }
  return sample;
}

samples_t ToMessage(const std::vector<BoardSample>& samples,
                    std::int64_t revision,
                    bool is_finished,
                    const std::string& log_sha256) {
  samples_t message{};
  message.revision = revision;
  message.is_finished = is_finished ? 1 : 0;
  message.log_sha256 = log_sha256;
  for (const BoardSample& sample : samples) {
    message.utime = std::max(message.utime, sample.utime);
    message.samples.push_back(ToMessage(sample));
  }
  message.num_samples = static_cast<std::int32_t>(message.samples.size());
  return message;
}

std::vector<BoardSample> FromMessage(const samples_t& message) {
  std::vector<BoardSample> samples;
  for (const sample_t& sample : message.samples) samples.push_back(FromMessage(sample));
  return samples;
}

}  // namespace voqcal
