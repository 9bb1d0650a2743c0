#include "system/system_test.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>

#include "files/atomic_file.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal::test {
namespace {

pid_t Start(const std::vector<std::string>& args,
            const std::filesystem::path& out,
            const std::filesystem::path& err) {
  std::vector<char*> argv;
  for (const std::string& arg : args) argv.push_back(const_cast<char*>(arg.c_str()));
  argv.push_back(nullptr);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND;
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), kFlags, 0666);
  posix_spawn_file_actions_addopen(&files, 2, err.c_str(), kFlags, 0666);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::generic_category(), args[0]);
  return pid;
}

int StatusOf(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) != pid) throw std::runtime_error("waitpid failed");
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::string ReplacedAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

Outcome Run(const std::vector<std::string>& args) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto err = folder.path() / "err";
  Outcome outcome;
  outcome.status = StatusOf(Start(args, out, err));
  outcome.out = ReadWholeFile(out);
  outcome.err = ReadWholeFile(err);
  return outcome;
}

std::string Program(const std::string& name) {
  return std::string(std::getenv("VOQCAL_BIN")) + "/" + name;
}

std::string Tool(const std::string& name) {
  return std::string(VOQCAL_SOURCE_DIR) + "/tools/" + name;
}

Process::Process(const std::vector<std::string>& args, const std::filesystem::path& output)
    : pid_(Start(args, output, output)) {}

Process::~Process() {
  if (pid_ <= 0) return;
  Signal(SIGKILL);
  Wait();
}

void Process::Signal(int signal) const { kill(pid_, signal); }

int Process::Wait() {
  const int status = StatusOf(pid_);
  pid_ = -1;
  return status;
}

std::vector<std::string> NamesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string Replaced(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::logic_error("the text must have '" + from + "' once");
  }
  return text.substr(0, at) + to + text.substr(at + from.size());
}

std::string SimulatedRigText() {
  return ReadWholeFile(std::filesystem::path(VOQCAL_SOURCE_DIR) / "config" / "rigs" /
                       "simulated_vlp16.yaml");
}

std::string ShortRigText() {
  std::string text = SimulatedRigText();
  const auto set = [&text](const std::string& key, const std::string& from, const std::string& to) {
    text = Replaced(text, "\n  " + key + ": " + from, "\n  " + key + ": " + to);
  };
  set("width_px", "1280", "640");
  set("height_px", "800", "400");
  set("fx_px", "750.0", "375.0");
  set("fy_px", "750.0", "375.0");
  set("cx_px", "641.5", "320.5");
  set("cy_px", "398.0", "198.75");
  set("rate_hz", "10", "5");  // of the lidar; the camera has 5
  set("num_poses", "40", "8");
  set("hold_s", "1.0", "0.8");
  set("move_s", "0.5", "0.4");
  set("max_distance_m", "4.5", "3.0");  // the small image has half the pixels on a board
  return Replaced(text, "239.255.76.67:7767", "239.255.76.67:7791");
}

std::string SmallRigOfSeveralText() {
  std::string text =
      ReadWholeFile(std::string(VOQCAL_SOURCE_DIR) + "/config/rigs/simulated_several.yaml");
  const std::pair<const char*, const char*> changes[] = {
      {"width_px: 1280", "width_px: 640"},
      {"height_px: 800", "height_px: 400"},
      {"cx_px: 641.5", "cx_px: 320.5"},
      {"cy_px: 396.0", "cy_px: 197.75"},
      {"fx_px: 750.0", "fx_px: 375.0"},
      {"fy_px: 751.5", "fy_px: 375.75"},
      {"fx_px: 800.0", "fx_px: 400.0"},
      {"fy_px: 801.5", "fy_px: 400.75"},
      {"fx_px: 780.0", "fx_px: 390.0"},
      {"fy_px: 781.5", "fy_px: 390.75"},
      {"pattern: raster", "pattern: vlp16"},
      {"num_poses: 40", "num_poses: 12"},
      {"hold_s: 1.5", "hold_s: 0.8"},
      {"move_s: 0.5", "move_s: 0.4"},
      {"max_distance_m: 3.5", "max_distance_m: 2.5"},
      {"239.255.76.67:7768", "239.255.76.67:7793"}};
  for (const auto& [from, to] : changes) text = ReplacedAll(text, from, to);
  return text;
}

}  // namespace voqcal::test
