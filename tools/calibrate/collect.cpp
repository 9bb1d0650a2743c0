#include "calibrate/collect.hpp"

#include <stdexcept>

#include <spdlog/spdlog.h>

#include "common/progress.hpp"
#include "messaging/log.hpp"
#include "rig/poses_csv.hpp"
#include "sample_collector/session_log.hpp"

namespace voqcal {
namespace {

// A samples.lcm is the session itself: the run goes on from a copy of it.
std::unique_ptr<OfflineRun> RunFromSamplesLog(const Rig& rig,
                                              const std::filesystem::path& log,
                                              const std::filesystem::path& session_folder) {
  // Read to its end first: a cut log is refused here, where LogWriter would mend it.
  LogReader reader(log);
  while (reader.Next()) {
  }
  std::filesystem::copy_file(log, session_folder / kSamplesLogName);
  return std::make_unique<OfflineRun>(rig, session_folder);
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
                                             const std::filesystem::path& log,
                                             const std::filesystem::path& session_folder) {
  auto run = std::make_unique<OfflineRun>(rig, session_folder);
  Progress progress("reading " + log.filename().string());
  run->FeedLog(log, [&progress](double share, std::size_t num_samples) {
    progress.Show(share, std::to_string(num_samples) + " samples");
  });
  return run;
}

}  // namespace

std::unique_ptr<OfflineRun> CollectSamples(const Rig& rig,
                                           const InputPaths& input,
                                           const std::filesystem::path& session_folder) {
  if (input.poses) return RunFromTable(rig, *input.poses, session_folder);
  if (IsSamplesLog(rig, *input.log)) return RunFromSamplesLog(rig, *input.log, session_folder);
  return RunFromRecording(rig, *input.log, session_folder);
}

std::string CountsOf(const OfflineRun& run) {
  std::string text;
  for (const Module* module : run.modules()) {
    if (module->counters().empty()) continue;
    text += (text.empty() ? "" : "; ") + module->Name() + ": " + module->Summary();
  }
  const std::string losses = run.Losses();
  return losses.empty() ? text : text + "; in the recording: " + losses;
}

}  // namespace voqcal
