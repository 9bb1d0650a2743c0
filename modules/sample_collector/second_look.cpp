#include "sample_collector/second_look.hpp"

#include <stdexcept>
#include <utility>

#include "core/lidar_detection/lidar_board.hpp"
#include "core/selection/consistency.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_points.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxBytes = 256U << 20U;  // some hundred sweeps of a 128-beam lidar

PointCloud CloudOf(const SensorFrame& sweep) {
  pointcloud2_t message{};
  const std::string problem = DecodeMessage(sweep.bytes.data(), sweep.bytes.size(), &message);
  if (!problem.empty()) throw std::runtime_error("a sweep that was kept: " + problem);
  return FromMessage(message);
}

std::size_t NumBytes(const KeptStop& kept) {
  std::size_t num = kept.image ? kept.image->bytes.size() : 0;
  for (const SensorFrame& sweep : kept.sweeps) num += sweep.bytes.size();
  return num;
}

// The stop as a vote: the camera's board, and all that the lidar took for it or was unsure of.
BoardSample VoteOf(const UnsureStop& stop) {
  BoardSample vote;
  vote.camera = *stop.camera.front().board;
  const LidarSighting& lidar = stop.lidar.front();
  std::vector<LidarBoard> candidates = lidar.unsure;
  if (lidar.board) {
    candidates = lidar.runners_up;
    candidates.insert(candidates.begin(), *lidar.board);
  }
  if (candidates.empty()) return vote;
  vote.lidar = candidates.front();
  vote.runners_up.assign(candidates.begin() + 1, candidates.end());
  return vote;
}

}  // namespace

bool SecondLook::Keep(UnsureStop stop, const FrameBuffer& sweeps, const FrameBuffer& images) {
  KeptStop kept;
  for (const LidarSighting& lidar : stop.lidar) {
    const SensorFrame* sweep = sweeps.Find(lidar.utime);
    if (sweep == nullptr) return false;
    kept.sweeps.push_back(*sweep);
  }
  if (const SensorFrame* image = images.Find(stop.camera.front().utime)) kept.image = *image;
  if (num_bytes_ + NumBytes(kept) > kMaxBytes) return false;
  num_bytes_ += NumBytes(kept);
  kept.stop = std::move(stop);
  kept_.push_back(std::move(kept));
  return true;
}

void SecondLook::Clear() {
  kept_.clear();
  num_bytes_ = 0;
}

std::vector<KeptStop> SecondLook::FindBoards(const std::vector<BoardSample>& samples,
                                             bool is_newest_spared,
                                             std::vector<std::string>* misses) {
  std::vector<BoardSample> votes = samples;
  for (const KeptStop& kept : kept_) votes.push_back(VoteOf(kept.stop));
  const auto extrinsic =
      VoteForExtrinsic(votes, samples.size(), rig_.camera, rig_.T_camera_lidar_guess);
  if (!extrinsic) {
    misses->insert(misses->end(), kept_.size(), "too few stops agree on where to look");
    return {};
  }
  std::vector<KeptStop> found;
  std::vector<KeptStop> left;
  for (KeptStop& kept : kept_) {
    if (is_newest_spared && &kept == &kept_.back()) {
      left.push_back(std::move(kept));
      continue;
    }
    const std::string miss = FindBoard(*extrinsic, &kept);
    if (!miss.empty()) misses->push_back(miss);
    (miss.empty() ? found : left).push_back(std::move(kept));
  }
  kept_ = std::move(left);
  for (const KeptStop& each : found) num_bytes_ -= NumBytes(each);
  return found;
}

// The stop's sightings become those of the second look. @return why there is none in one of its
// sweeps; empty if there is one in each.
std::string SecondLook::FindBoard(const RoughExtrinsic& extrinsic, KeptStop* kept) const {
  UnsureStop found = kept->stop;
  for (std::size_t i = 0; i < kept->sweeps.size(); ++i) {
    const ExpectedBoard expected = ExpectBoard(found.camera[i].board->pose, extrinsic);
    const BoardPrior prior = {expected.T_lidar_board, expected.covariance};
    auto boards = DetectLidarBoard(CloudOf(kept->sweeps[i]),
                                   rig_.board,
                                   rig_.lidar_board_detector,
                                   /*background=*/nullptr,
                                   prior);
    if (!boards) return ToString(boards.error().miss);
    LidarSighting& sighting = found.lidar[i];
    sighting.board = boards->front();
    sighting.runners_up.clear();
    sighting.unsure.clear();
    sighting.miss.clear();
  }
  kept->stop = std::move(found);
  return {};
}

}  // namespace voqcal
