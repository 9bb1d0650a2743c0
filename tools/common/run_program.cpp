#include "common/run_program.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace voqcal {

std::string ScriptOfTools(const std::string& script) {
  const std::string installed = FileBesidePrograms("tools/" + script);
  return std::filesystem::exists(installed) ? installed : VOQCAL_TOOLS_FOLDER "/" + script;
}

std::string FileBesidePrograms(const std::string& file) {
  const std::filesystem::path bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  return bin.parent_path() / file;
}

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

}  // namespace voqcal
