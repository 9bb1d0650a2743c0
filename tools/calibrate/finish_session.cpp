#include "calibrate/finish_session.hpp"

#include <spdlog/spdlog.h>
#include <system_error>

#include "calibrate/advice.hpp"
#include "calibrate/collect.hpp"
#include "common/tool_main.hpp"
#include "core/selection/offset_sign.hpp"
#include "messaging/log.hpp"
#include "report/no_result.hpp"
#include "report/write_report.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

// Moves the finished files to where they were asked for, the result last. A report that could not
// be made must not leave an earlier one beside a new result.
void Deliver(const SessionFolders& folders) {
  const auto& [from, to] = folders;
  RequireNotBeingWritten(to / kSamplesLogName);
  std::error_code error;
  std::filesystem::create_directories(to, error);
  if (!std::filesystem::exists(from / kReportName))
    std::filesystem::remove(to / kReportName, error);
  std::filesystem::remove(to / kNoResultName, error);
  for (const char* name : {kReportName, kSamplesLogName, kResultJsonName, kResultName}) {
    if (error || !std::filesystem::exists(from / name)) continue;
    std::filesystem::rename(from / name, to / name, error);
  }
  if (error) throw std::runtime_error(to.string() + ": cannot write: " + error.message());
}

// Says so if a result is there that is not the one just asked for.
std::string EarlierResultIn(const std::filesystem::path& folder) {
  const std::filesystem::path result = folder / kResultName;
  return std::filesystem::exists(result) ? "; " + result.string() + " is of an earlier run" : "";
}

/// Makes a page of what was seen, where there is no result. @return where it is, as a line.
std::string SeenInstead(const Rig& rig,
                        const OfflineRun& run,
                        const std::string& problem,
                        const SessionFolders& folders) {
  const std::string page_problem =
      WriteNoResult(rig, problem, run.samples(), folders.scratch, folders.out);
  return page_problem.empty() ? "\nwhat was seen: " + (folders.out / kNoResultName).string()
                              : "\nno page of what was seen: " + page_problem;
}

}  // namespace

void FinishSession(const Rig& rig,
                   const std::filesystem::path& input,
                   const SessionFolders& folders,
                   OfflineRun* run) {
  run->Finish(/*is_collecting_only=*/false);
  const std::string wrong_sign = WrongOffsetSign(run->samples(), rig.board);
  if (!run->assessor().result()) {
    const std::string why = input.string() + ": no calibration: " + run->assessor().problem();
    const std::string advice = FailureAdvice(*run) + (wrong_sign.empty() ? "" : "\n" + wrong_sign);
    throw NoCalibration(why + EarlierResultIn(folders.out) + advice + CountsLine(*run) +
                        SeenInstead(rig, *run, why + advice, folders));
  }
  const std::string report_problem = WriteReport(rig, *run, folders.scratch);
  Deliver(folders);
  if (!wrong_sign.empty()) spdlog::warn("{}: {}", rig.path.string(), wrong_sign);
  if (!report_problem.empty()) spdlog::warn("no {}: {}", kReportName, report_problem);
}

void RequireVerdict(const Verdict& verdict, const std::string& demand) {
  if (demand.empty()) return;
  const Grade least = demand == "good" ? Grade::kGood : Grade::kLook;
  if (verdict.grade <= least) return;
  throw DemandNotMet("the result is not " + demand + ", as --require demands: " + verdict.headline);
}

}  // namespace voqcal
