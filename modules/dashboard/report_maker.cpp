#include "dashboard/report_maker.hpp"

#include <csignal>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace voqcal {

ReportMaker::ReportMaker(std::vector<std::string> command,
                         const std::filesystem::path& output,
                         std::chrono::milliseconds patience)
    : command_(std::move(command)), output_(output), patience_(patience) {}

ReportMaker::~ReportMaker() {
  if (!IsAtWork()) return;
  kill(-pid_, SIGTERM);
  const auto end = std::chrono::steady_clock::now() + patience_;
  while (IsAtWork() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (pid_ > 0) Kill();
}

bool ReportMaker::Start() {
  if (IsAtWork()) return true;
  std::vector<char*> argv;
  for (std::string& arg : command_) argv.push_back(arg.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(
      &actions, STDOUT_FILENO, output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // The page's port and the LCM network are not the child's to keep, should it outlive this
  // process.
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // a group of its own
  const int error = posix_spawn(&pid_, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) pid_ = -1;
  return error == 0;
}

// It is not reaped before its group is killed: its number might be another's by then.
bool ReportMaker::IsAtWork() {
  if (pid_ < 0) return false;
  siginfo_t ended{};
  const int error = waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
  if (error == 0 && ended.si_pid == 0) return true;
  Kill();
  return false;
}

void ReportMaker::Kill() {
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

}  // namespace voqcal
