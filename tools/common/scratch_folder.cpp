#include "common/scratch_folder.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace voqcal {
namespace {

// What an interrupted process removes: the outermost scratch folder, in which others lie.
char g_path[4096] = "";

// Only what signal-safety(7) allows: removing a tree is left to a child. Then the signal does what
// it would have done.
void RemoveAndDie(int signal) {
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/rm", "rm", "-rf", "--", g_path, static_cast<char*>(nullptr));
    _exit(EXIT_FAILURE);
  }
  if (child > 0) waitpid(child, nullptr, 0);
  raise(signal);
}

// Signals that are ignored, as under nohup, stay so.
void SetHandler(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

}  // namespace

ScratchFolder::ScratchFolder(const std::filesystem::path& beside) {
  const std::filesystem::path absolute = std::filesystem::absolute(beside).lexically_normal();
  // "out/" has an empty file name; its folder is the one before the slash.
  const std::filesystem::path target = absolute.has_filename() ? absolute : absolute.parent_path();
  std::error_code error;
  parents_end_ = target.parent_path();
  while (!std::filesystem::exists(parents_end_, error) && parents_end_.has_relative_path()) {
    parents_end_ = parents_end_.parent_path();
  }
  std::filesystem::create_directories(target.parent_path(), error);
  if (error) {
    throw std::runtime_error(target.parent_path().string() +
                             ": cannot make the folder: " + error.message());
  }
  std::string name = target.string() + ".unfinished-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error(target.string() + ": cannot be written: " + std::strerror(errno));
  }
  path_ = name;
  is_outermost_ = g_path[0] == '\0' && name.size() < sizeof(g_path);
  if (!is_outermost_) return;
  std::strcpy(g_path, name.c_str());
  SetHandler(&RemoveAndDie);
}

ScratchFolder::~ScratchFolder() {
  if (is_outermost_) {
    SetHandler(SIG_DFL);
    g_path[0] = '\0';
  }
  std::error_code ignored;  // what cannot be removed cannot be told to anyone from here
  std::filesystem::remove_all(path_, ignored);
  // remove() leaves a folder that has something in it.
  for (auto folder = path_.parent_path(); folder != parents_end_; folder = folder.parent_path()) {
    if (!std::filesystem::remove(folder, ignored)) break;
  }
}

}  // namespace voqcal
