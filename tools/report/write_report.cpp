#include "report/write_report.hpp"

#include <cerrno>
#include <cstring>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>

#include "common/scratch_folder.hpp"
#include "messaging/session_scenes.hpp"
#include "report/overlays.hpp"
#include "report/result_json.hpp"
#include "rig/atomic_file.hpp"

namespace voqcal {
namespace {

/// Beside the programs where they are installed, else in the source tree that they were built from.
std::string ReportProgram() {
  const std::filesystem::path bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::filesystem::path installed = bin.parent_path() / "tools/report/make_report.py";
  return std::filesystem::exists(installed) ? installed.string() : VOQCAL_REPORT_PROGRAM;
}

/// Runs a program to its end. @return what went wrong; empty if it ended well.
std::string RunProgram(const std::vector<std::string>& args) {
  std::vector<char*> argv;
  for (const std::string& arg : args) argv.push_back(const_cast<char*>(arg.c_str()));
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, argv[0], nullptr, nullptr, argv.data(), environ);
  if (error != 0) return args[0] + ": " + std::strerror(error);
  int status = 0;
  while (waitpid(pid, &status, 0) != pid) {
    if (errno != EINTR) return args[0] + ": " + std::strerror(errno);
  }
  return status == 0 ? "" : args[0] + " failed (its message is above)";
}

}  // namespace

std::string WriteReport(const Rig& rig,
                        const OfflineRun& run,
                        const std::filesystem::path& folder) {
  const std::filesystem::path json = folder / kResultJsonName;
  WriteFileAtomically(json, ResultJson(rig, run));
  const ScratchFolder overlays(folder / "overlays");
  WriteOverlays(rig, run, folder / kSamplesLogName, overlays.path());
  return RunProgram({ReportProgram(), json, overlays.path(), folder / kReportName});
}

}  // namespace voqcal
