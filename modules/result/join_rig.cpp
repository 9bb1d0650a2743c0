#include "result/join_rig.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "core/add_if_new.hpp"

namespace voqcal {
namespace {

/// Two cameras, by what their sessions have in common; nothing if that is too little.
std::optional<CalibratedPair> CalibrateCameras(const PairSession& from,
                                               const PairSession& to,
                                               const std::vector<PairSession>& sessions) {
  const CommonBoardLimits limits{from.sampling.max_pair_offset_s,
                                 from.sampling.min_new_distance_m,
                                 from.sampling.min_new_angle_rad};
  std::vector<CommonBoard> boards;
  bool is_of_two_times = false;
  for (const PairSession& each : sessions) {
    for (const PairSession& other : sessions) {
      if (each.camera != from.camera || other.camera != to.camera) continue;
      if (each.use_log_times != other.use_log_times) {
        is_of_two_times = true;
        continue;
      }
      AddCommonBoards(each.boards, other.boards, limits, &boards);
    }
  }
  if (is_of_two_times) {
    spdlog::warn(
        "{}: boards whose times are stamps are not compared with those whose times are the log's",
        PairName(from.camera, to.camera));
  }
  const auto extrinsic = PairOfCameras(from.camera, to.camera, boards, to.lens);
  if (!extrinsic || !IsDefinite(*extrinsic)) return std::nullopt;
  CalibratedPair pair;
  pair.extrinsic = *extrinsic;
  pair.num_samples = static_cast<int>(boards.size());
  return pair;
}

void AddPairsOfCameras(const std::vector<PairSession>& sessions,
                       std::vector<CalibratedPair>* pairs) {
  std::vector<const PairSession*> cameras;  // the first of each
  for (const PairSession& session : sessions) {
    const bool is_there = std::any_of(cameras.begin(), cameras.end(), [&](const auto* each) {
      return each->camera == session.camera;
    });
    if (!is_there) cameras.push_back(&session);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (std::size_t j = i + 1; j < cameras.size(); ++j) {
      const auto pair = CalibrateCameras(*cameras[i], *cameras[j], sessions);
      if (pair) pairs->push_back(*pair);
    }
  }
}

SensorNetwork Join(const RigExtrinsics& result, const std::string& reference) {
  std::vector<SensorPair> joined;
  for (const CalibratedPair& pair : result.pairs) {
    if (pair.problem.empty()) joined.push_back(pair.extrinsic);
  }
  std::vector<std::string> names = result.lidars;
  names.insert(names.end(), result.cameras.begin(), result.cameras.end());
  return JoinPairs(names, reference.empty() ? result.lidars.front() : reference, joined);
}

}  // namespace

void TakeResult(const std::vector<BoardSample>& samples,
                const std::optional<CalibrationResult>& result,
                const std::string& problem,
                PairSession* session) {
  session->boards.clear();
  for (const BoardSample& sample : samples) {
    const bool is_used =
        !result || std::count(result->used_ids.begin(), result->used_ids.end(), sample.id) > 0;
    if (is_used) session->boards.push_back({sample.camera_utime, sample.camera.pose});
  }
  CalibratedPair& pair = session->pair;
  pair = {};
  pair.folder = PairName(session->lidar, session->camera);
  pair.extrinsic.from = session->lidar;
  pair.extrinsic.to = session->camera;
  pair.num_samples = static_cast<int>(samples.size());
  if (!result) {
    pair.problem = samples.empty() ? "the two never saw the board rest at one time" : problem;
    return;
  }
  pair.extrinsic.T_to_from = result->T_camera_lidar;
  pair.extrinsic.covariance = result->covariance_given_rig;
  pair.verdict = VerdictOf(*result);
  pair.num_samples = static_cast<int>(result->used_ids.size());
  pair.samples_sha256 = result->made_from.log_sha256;
  if (!IsDefinite(pair.extrinsic)) {
    pair.problem = "its poses are too few, or too alike, to tell how certain it is";
  }
}

RigExtrinsics JoinSessions(const std::vector<PairSession>& sessions,
                           const std::string& reference,
                           const RigMadeFrom& made_from) {
  RigExtrinsics result;
  result.rig = made_from.rig;
  result.rig_sha256 = made_from.rig_sha256;
  result.version = made_from.version;
  for (const PairSession& session : sessions) {
    AddIfNew(session.lidar, &result.lidars);
    AddIfNew(session.camera, &result.cameras);
    result.pairs.push_back(session.pair);
  }
  AddPairsOfCameras(sessions, &result.pairs);
  result.network = Join(result, reference);
  return result;
}

std::vector<PairInTree> PairsInTree(const RigExtrinsics& result) {
  std::vector<PairInTree> pairs;
  if (!result.network.IsUsable()) return pairs;
  for (const CalibratedPair& pair : result.pairs) {
    if (!pair.HasSession() || !pair.problem.empty()) continue;
    const SensorPair joined = result.network.Between(pair.extrinsic.from, pair.extrinsic.to);
    const Vector6d variance = joined.covariance.diagonal();
    pairs.push_back(
        {pair.Name(), std::sqrt(variance.head<3>().sum()), std::sqrt(variance.tail<3>().sum())});
  }
  return pairs;
}

}  // namespace voqcal
