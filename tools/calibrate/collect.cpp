#include "calibrate/collect.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include <spdlog/spdlog.h>
#include <system_error>

#include "common/progress.hpp"
#include "core/format.hpp"
#include "messaging/log.hpp"
#include "result/poses_csv.hpp"

namespace voqcal {
namespace {

// Root of the mean squared distance of the corners that were seen from where the pose puts them;
// NaN if none was.
double ReprojectionRmsPx(const CameraBoard& seen,
                         const BoardSpec& board,
                         const CameraModel& camera) {
  const std::vector<Eigen::Vector3d> corners_board_m = board.InnerCornersBoardM();
  if (seen.corners_px.size() != corners_board_m.size()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Eigen::Isometry3d T_camera_board = TransformFromPose(seen.pose);
  double sum_px2 = 0.0;
  int num_seen = 0;
  for (std::size_t i = 0; i < corners_board_m.size(); ++i) {
    if (!seen.corners_px[i].allFinite()) continue;
    const Eigen::Vector3d corner_camera_m = T_camera_board * corners_board_m[i];
    if (!camera.IsInFront(corner_camera_m)) return std::numeric_limits<double>::infinity();
    sum_px2 += (camera.Project(corner_camera_m) - seen.corners_px[i]).squaredNorm();
    ++num_seen;
  }
  return std::sqrt(sum_px2 / num_seen);
}

// A sample has the board's pose by the intrinsics that it was taken with: others would not change
// it, only spoil what is made of it.
void RequireThisCamera(const std::filesystem::path& log,
                       const std::vector<BoardSample>& samples,
                       const Rig& rig) {
  for (const BoardSample& sample : samples) {
    const double rms_px = ReprojectionRmsPx(sample.camera, rig.board, rig.camera);
    if (!(rms_px > rig.camera_board_detector.max_reprojection_rms_px)) continue;
    throw std::runtime_error(
        log.string() +
        Format(": sample %lld was taken with other intrinsics, or of another board, than %s says: "
               "its corners are %.1f px off; calibrate the recording itself",
               static_cast<long long>(sample.id),
               rig.path.c_str(),
               rms_px));
  }
}

// A samples.lcm is the session itself: the run goes on from a copy of it.
std::unique_ptr<OfflineRun> RunFromSamplesLog(const Rig& rig,
                                              const std::filesystem::path& log,
                                              const std::filesystem::path& session_folder) {
  // Read to its end first: a cut log is refused here, where LogWriter would mend it.
  LogReader reader(log);
  while (reader.Next()) {
  }
  std::error_code error;
  std::filesystem::copy_file(log, session_folder / kSamplesLogName, error);
  if (error) {  // of a full disk the library says only "Input/output error"
    std::error_code unknown;
    const bool is_full = std::filesystem::space(session_folder, unknown).available <
                         std::filesystem::file_size(log, unknown);
    throw std::runtime_error(session_folder.string() + ": cannot be written: " +
                             (is_full ? "No space left on device" : error.message()));
  }
  auto run = std::make_unique<OfflineRun>(rig, session_folder);
  RequireThisCamera(log, run->samples(), rig);
  return run;
}

std::unique_ptr<OfflineRun> RunFromTable(const Rig& rig,
                                         const std::filesystem::path& table,
                                         const std::filesystem::path& session_folder) {
  const PosesCsv poses = ReadPosesCsv(table, rig.board);
  for (const std::string& remark : poses.remarks) spdlog::info("{}: {}", table.string(), remark);
  auto run = std::make_unique<OfflineRun>(rig, session_folder);
  run->FeedSamples(poses.samples);
  return run;
}

std::unique_ptr<OfflineRun> RunFromRecording(const Rig& rig,
                                             const InputPaths& input,
                                             const std::filesystem::path& session_folder) {
  const std::filesystem::path& log = *input.log;
  auto run = std::make_unique<OfflineRun>(rig, session_folder);
  Progress progress("reading " + log.filename().string());
  const auto on_progress = [&progress](double share, std::size_t num_samples) {
    progress.Show(share, std::to_string(num_samples) + " samples");
  };
  run->FeedLog(log, on_progress, input.times);
  return run;
}

}  // namespace

std::unique_ptr<OfflineRun> CollectSamples(const Rig& rig,
                                           const InputPaths& input,
                                           const std::filesystem::path& session_folder) {
  if (input.poses) return RunFromTable(rig, *input.poses, session_folder);
  if (IsSamplesLog(rig, *input.log)) return RunFromSamplesLog(rig, *input.log, session_folder);
  return RunFromRecording(rig, input, session_folder);
}

std::string CountsOf(const OfflineRun& run) {
  std::string text;
  for (const Module* module : run.modules()) {
    const auto& counters = module->counters();
    const bool counts_failure_alone = counters.size() == counters.count("without a result");
    if (counts_failure_alone) continue;
    text += (text.empty() ? "" : "; ") + module->Name() + ": " + module->Summary();
  }
  const std::string losses = run.Losses();
  if (losses.empty()) return text;
  return text + (text.empty() ? "" : "; ") + "in the recording: " + losses;
}

std::string CountsLine(const OfflineRun& run) {
  const std::string counts = CountsOf(run);
  return counts.empty() ? "" : "\ncounted: " + counts;
}

}  // namespace voqcal
