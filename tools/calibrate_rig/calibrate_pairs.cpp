#include "calibrate_rig/calibrate_pairs.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "calibrate/detected_boards.hpp"
#include "calibrate/finish_session.hpp"
#include "calibrate/offline_run.hpp"
#include "common/progress.hpp"
#include "core/geometry/rigid.hpp"
#include "core/parallel.hpp"
#include "core/sensor_network/common_boards.hpp"

namespace voqcal {
namespace {

/// A sensor, and by which times: clocks are judged by pair.
using SensorKey = std::pair<std::string, bool>;
using BoardsBySensor = std::map<SensorKey, std::unique_ptr<DetectedBoards>>;

/// One detector's work.
struct Detection {
  const Rig* rig = nullptr;
  DetectedBoards::Sensor sensor = DetectedBoards::Sensor::kLidar;
  SensorKey key;
};

/// By pair.
std::vector<bool> UseLogTimes(const std::vector<Rig>& pairs,
                              const std::filesystem::path& log,
                              RecordingTimes times) {
  std::vector<bool> use_log_times;
  for (const Rig& rig : pairs) {
    use_log_times.push_back(times == RecordingTimes::kLog);
    if (times != RecordingTimes::kAuto) continue;
    const ClockVerdict verdict = JudgeClocksOf(log, rig.channels);
    if (!verdict.words.empty())
      spdlog::warn("{}: {}: {}", log.string(), FolderOf(rig), verdict.words);
    use_log_times.back() = verdict.use_log_times;
  }
  return use_log_times;
}

std::vector<Detection> DetectionsOf(const std::vector<Rig>& pairs,
                                    const std::vector<bool>& use_log_times) {
  std::vector<Detection> detections;
  const auto add = [&detections](const Detection& detection) {
    const bool is_there = std::any_of(detections.begin(), detections.end(), [&](const auto& each) {
      return each.key == detection.key;
    });
    if (!is_there) detections.push_back(detection);
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Rig& rig = pairs[i];
    add({&rig, DetectedBoards::Sensor::kLidar, {rig.lidar_name, use_log_times[i]}});
    add({&rig, DetectedBoards::Sensor::kCamera, {rig.camera_name, use_log_times[i]}});
  }
  return detections;
}

/// The share done of work that goes on in several threads.
class SharedProgress {
 public:
  SharedProgress(const std::string& what, std::size_t num) : progress_(what), shares_(num, 0.0) {}

  void Show(std::size_t i, double share) {
    const std::lock_guard<std::mutex> lock(mutex_);
    shares_[i] = share;
    const double sum = std::accumulate(shares_.begin(), shares_.end(), 0.0);
    progress_.Show(sum / static_cast<double>(shares_.size()),
                   std::to_string(shares_.size()) + " sensors");
  }

 private:
  std::mutex mutex_;
  Progress progress_;
  std::vector<double> shares_;
};

BoardsBySensor Detect(const std::vector<Detection>& detections, const std::filesystem::path& log) {
  SharedProgress progress("looking for boards in " + log.filename().string(), detections.size());
  std::vector<std::unique_ptr<DetectedBoards>> found(detections.size());
  ParallelFor(detections.size(), [&](std::size_t i) {
    const Detection& each = detections[i];
    found[i] = std::make_unique<DetectedBoards>(
        *each.rig, each.sensor, log, each.key.second, [&progress, i](double share) {
          progress.Show(i, share);
        });
  });
  BoardsBySensor boards;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    boards[detections[i].key] = std::move(found[i]);
  }
  return boards;
}

/// Memory that can be had without swapping: the page cache gives way.
double AvailableBytes() {
  std::ifstream meminfo("/proc/meminfo");
  for (std::string line; std::getline(meminfo, line);) {
    std::istringstream words(line);
    std::string key;
    double kilobytes = 0.0;
    if (words >> key >> kilobytes && key == "MemAvailable:") return 1024 * kilobytes;
  }
  return static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) *
         static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Pairs: each keeps some seconds of sweeps and images; all together work on a decoded scene a
/// core.
std::size_t MostAtOnce() {
  constexpr double kBytesOfPair = 1e9;
  constexpr double kBytesOfScene = 1e8;  // an image of 8 MP with its gradients, a sweep
  const double bytes_of_scenes = kBytesOfScene * static_cast<double>(1 + Helpers::Shared().num());
  return static_cast<std::size_t>(
      std::max(1.0, (AvailableBytes() - bytes_of_scenes) / kBytesOfPair));
}

/// A pose of the board in a session, as its camera saw it.
struct SeenBoard {
  std::int64_t camera_utime = 0;
  BoardPose pose;
};

/// A pair, and what its camera saw.
struct Session {
  CalibratedPair pair;
  bool use_log_times = false;  ///< For the boards' times.
  std::vector<SeenBoard> boards;
};

std::vector<SeenBoard> BoardsOf(const OfflineRun& run) {
  const auto& result = run.assessor().result();
  std::vector<SeenBoard> boards;
  for (const BoardSample& sample : run.samples()) {
    const bool is_used =
        !result || std::count(result->used_ids.begin(), result->used_ids.end(), sample.id) > 0;
    if (is_used) boards.push_back({sample.camera_utime, sample.camera.pose});
  }
  return boards;
}

Session Calibrate(const Rig& rig,
                  const std::filesystem::path& log,
                  bool use_log_times,
                  const BoardsOfPair& boards,
                  const RigFolders& folders) {
  Session calibrated;
  calibrated.use_log_times = use_log_times;
  CalibratedPair& pair = calibrated.pair;
  pair.folder = FolderOf(rig);
  pair.extrinsic.from = rig.lidar_name;
  pair.extrinsic.to = rig.camera_name;
  const SessionFolders session_folders = {folders.scratch / pair.folder, folders.out / pair.folder};
  std::filesystem::create_directories(session_folders.scratch);
  OfflineRun run(rig, session_folders.scratch, boards);
  const auto times = use_log_times ? RecordingTimes::kLog : RecordingTimes::kStamps;
  run.FeedLog(
      log, [](double, std::size_t) {}, times);
  try {
    FinishSession(rig, log, session_folders, &run);
  } catch (const NoCalibration& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) spdlog::warn("{}: {}", pair.folder, line);
    pair.problem = run.samples().empty() ? "the two never saw the board rest at one time"
                                         : run.assessor().problem();
    calibrated.boards = BoardsOf(run);
    return calibrated;
  }
  calibrated.boards = BoardsOf(run);
  const CalibrationResult& result = *run.assessor().result();
  pair.extrinsic.T_to_from = result.T_camera_lidar;
  pair.extrinsic.covariance = result.covariance;
  pair.verdict = VerdictOf(result);
  pair.num_samples = static_cast<int>(result.used_ids.size());
  pair.samples_sha256 = result.made_from.log_sha256;
  if (!result.covariance.allFinite()) {
    pair.problem = "its poses are too few to tell how certain it is";
  }
  return calibrated;
}

/// A pose that is in the list already would count twice.
bool IsNew(const BoardPose& pose,
           const std::vector<CommonBoard>& boards,
           const SamplePickerOptions& options) {
  return std::none_of(boards.begin(), boards.end(), [&](const CommonBoard& each) {
    return (each.from.centre_m - pose.centre_m).norm() < options.min_new_distance_m &&
           AngleBetween(each.from.normal, pose.normal) < options.min_new_angle_rad;
  });
}

/// Adds the poses that both cameras saw at one time. Each session's board was at rest.
void AddCommon(const std::vector<SeenBoard>& from,
               const std::vector<SeenBoard>& to,
               const SamplePickerOptions& options,
               std::vector<CommonBoard>* boards) {
  for (const SeenBoard& each : from) {
    for (const SeenBoard& other : to) {
      const double apart_s =
          1e-6 * static_cast<double>(std::abs(each.camera_utime - other.camera_utime));
      if (apart_s > options.max_pair_offset_s || !IsNew(each.pose, *boards, options)) continue;
      boards->push_back({each.pose, other.pose});
    }
  }
}

/// Two cameras, by what their sessions have in common; nothing if that is too little.
std::optional<CalibratedPair> CalibrateCameras(const Rig& from,
                                               const Rig& to,
                                               const std::vector<Rig>& rigs,
                                               const std::vector<Session>& sessions) {
  std::vector<CommonBoard> boards;
  bool is_of_two_times = false;
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    for (std::size_t j = 0; j < rigs.size(); ++j) {
      if (rigs[i].camera_name != from.camera_name || rigs[j].camera_name != to.camera_name)
        continue;
      if (sessions[i].use_log_times != sessions[j].use_log_times) {  // clocks are judged by pair
        is_of_two_times = true;
        continue;
      }
      AddCommon(sessions[i].boards, sessions[j].boards, from.sample_collector, &boards);
    }
  }
  if (is_of_two_times) {
    spdlog::warn(
        "{}: boards whose times are stamps are not compared with those whose times are the log's",
        PairName(from.camera_name, to.camera_name));
  }
  const auto extrinsic = PairOfCameras(from.camera_name, to.camera_name, boards, to.camera);
  if (!extrinsic || !extrinsic->covariance.allFinite()) return std::nullopt;
  CalibratedPair pair;
  pair.extrinsic = *extrinsic;
  pair.num_samples = static_cast<int>(boards.size());
  return pair;
}

void AddPairsOfCameras(const std::vector<Rig>& rigs,
                       const std::vector<Session>& sessions,
                       std::vector<CalibratedPair>* pairs) {
  std::vector<const Rig*> cameras;
  for (const Rig& rig : rigs) {
    const bool is_there = std::any_of(cameras.begin(), cameras.end(), [&rig](const Rig* each) {
      return each->camera_name == rig.camera_name;
    });
    if (!is_there) cameras.push_back(&rig);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (std::size_t j = i + 1; j < cameras.size(); ++j) {
      const auto pair = CalibrateCameras(*cameras[i], *cameras[j], rigs, sessions);
      if (pair) pairs->push_back(*pair);
    }
  }
}

}  // namespace

std::string FolderOf(const Rig& pair) { return PairName(pair.lidar_name, pair.camera_name); }

std::vector<CalibratedPair> CalibratePairs(const std::vector<Rig>& pairs,
                                           const std::filesystem::path& log,
                                           RecordingTimes times,
                                           const RigFolders& folders) {
  const std::vector<bool> use_log_times = UseLogTimes(pairs, log, times);
  const BoardsBySensor boards = Detect(DetectionsOf(pairs, use_log_times), log);
  std::vector<Session> sessions(pairs.size());
  ParallelFor(
      pairs.size(),
      [&](std::size_t i) {
        const bool use_log = use_log_times[i];
        const BoardsOfPair own = {boards.at({pairs[i].lidar_name, use_log}).get(),
                                  boards.at({pairs[i].camera_name, use_log}).get()};
        sessions[i] = Calibrate(pairs[i], log, use_log, own, folders);
      },
      MostAtOnce());
  std::vector<CalibratedPair> calibrated;
  for (const Session& session : sessions) calibrated.push_back(session.pair);
  AddPairsOfCameras(pairs, sessions, &calibrated);
  return calibrated;
}

}  // namespace voqcal
