#include "calibrate_rig/calibrate_pairs.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "calibrate/advice.hpp"
#include "calibrate/detected_boards.hpp"
#include "calibrate/finish_session.hpp"
#include "calibrate/offline_run.hpp"
#include "common/progress.hpp"
#include "core/parallel.hpp"
#include "rig_calibrator/pair_chain.hpp"

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
std::vector<bool> UseLogTimes(const std::vector<Rig>& pairs, const RigRecording& recording) {
  std::vector<bool> use_log_times;
  for (const Rig& rig : pairs) {
    use_log_times.push_back(recording.times == RecordingTimes::kLog);
    if (recording.times != RecordingTimes::kAuto) continue;
    const ClockVerdict verdict = JudgeClocksOf(recording.log, rig.channels);
    if (!verdict.words.empty())
      spdlog::warn("{}: {}: {}", recording.given, FolderOf(rig), verdict.words);
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

BoardsBySensor Detect(const std::vector<Detection>& detections, const RigRecording& recording) {
  SharedProgress progress("looking for boards in " + recording.given, detections.size());
  std::vector<std::unique_ptr<DetectedBoards>> found(detections.size());
  ParallelFor(detections.size(), [&](std::size_t i) {
    const Detection& each = detections[i];
    found[i] = std::make_unique<DetectedBoards>(
        *each.rig, each.sensor, recording.log, each.key.second, [&progress, i](double share) {
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

PairSession Calibrate(const Rig& rig,
                      const RigRecording& recording,
                      bool use_log_times,
                      const BoardsOfPair& boards,
                      const RigFolders& folders,
                      std::string* advice) {
  const std::string folder = FolderOf(rig);
  const SessionFolders session_folders = {folders.scratch / folder, folders.out / folder};
  std::filesystem::create_directories(session_folders.scratch);
  OfflineRun run(rig, session_folders.scratch, boards);
  const auto times = use_log_times ? RecordingTimes::kLog : RecordingTimes::kStamps;
  run.FeedLog(
      recording.log, [](double, std::size_t) {}, times);
  try {
    FinishSession(rig, recording.given, session_folders, &run);
  } catch (const NoCalibration& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) spdlog::warn("{}: {}", folder, line);
  }
  PairSession session = SessionOf(rig);
  session.use_log_times = use_log_times;
  TakeResult(run.samples(), run.assessor().result(), run.assessor().problem(), &session);
  if (!run.assessor().result()) *advice = FailureAdvice(run);
  return session;
}

}  // namespace

std::string FolderOf(const Rig& pair) { return PairName(pair.lidar_name, pair.camera_name); }

CalibratedPairs CalibratePairs(const std::vector<Rig>& pairs,
                               const RigRecording& recording,
                               const RigFolders& folders) {
  const std::vector<bool> use_log_times = UseLogTimes(pairs, recording);
  const BoardsBySensor boards = Detect(DetectionsOf(pairs, use_log_times), recording);
  CalibratedPairs calibrated;
  calibrated.sessions.resize(pairs.size());
  calibrated.advice.resize(pairs.size());
  ParallelFor(
      pairs.size(),
      [&](std::size_t i) {
        const bool use_log = use_log_times[i];
        const BoardsOfPair own = {boards.at({pairs[i].lidar_name, use_log}).get(),
                                  boards.at({pairs[i].camera_name, use_log}).get()};
        calibrated.sessions[i] =
            Calibrate(pairs[i], recording, use_log, own, folders, &calibrated.advice[i]);
      },
      MostAtOnce());
  return calibrated;
}

}  // namespace voqcal
