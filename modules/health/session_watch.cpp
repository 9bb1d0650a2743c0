#include "health/session_watch.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include <system_error>

namespace voqcal {
namespace {

/// A supervisor that starts a program again and again may write much.
constexpr std::streamoff kMaxTailBytes = 64 << 10;
constexpr std::time_t kLatelyS = 30;

/// The end of a file, from the start of a line if it is cut; empty if it cannot be read.
std::string TailOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const std::streamoff size = file.tellg();
  file.seekg(std::max<std::streamoff>(0, size - kMaxTailBytes));
  std::string tail(std::istreambuf_iterator<char>(file), {});
  return size > kMaxTailBytes ? tail.substr(std::min(tail.find('\n') + 1, tail.size())) : tail;
}

std::string LastLineOf(const std::string& text) {
  std::string last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

/// By the kernel's letter of its state: one that was killed may be there as a zombie yet.
SupervisorState StateOf(const std::filesystem::path& pid_file) {
  std::ifstream file(pid_file);
  long pid = 0;
  if (!(file >> pid) || pid <= 0) return SupervisorState::kDead;
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(") ");  // "7 (supervisord) S 1 ..."
  const char letter = name_end == std::string::npos ? 'X' : text.at(name_end + 2);
  if (letter == 'X' || letter == 'Z') return SupervisorState::kDead;
  return letter == 'T' || letter == 't' ? SupervisorState::kHalted : SupervisorState::kRuns;
}

/// raw.lcm, raw.2.lcm, ...: the one that was written last.
std::optional<std::int64_t> NewestRecordingBytes(const std::filesystem::path& folder) {
  std::optional<std::int64_t> num_bytes;
  std::filesystem::file_time_type newest{};
  std::error_code error;
  for (const auto& each : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = each.path().filename().string();
    if (name.rfind("raw.", 0) != 0 || each.path().extension() != ".lcm") continue;
    const auto written = each.last_write_time(error);
    if (error || (num_bytes && written < newest)) continue;
    newest = written;
    num_bytes = static_cast<std::int64_t>(each.file_size(error));
  }
  return num_bytes;
}

ProgramFacts FactsOf(const ProgramHistory& history,
                     const std::filesystem::path& output,
                     std::time_t now) {
  ProgramFacts facts;
  facts.history = history;
  if (history.is_running) facts.running_s = now - history.started;
  for (const std::time_t end : history.unexpected_ends) {
    if (now - end < kLatelyS) ++facts.num_ends_lately;
  }
  if (facts.num_ends_lately > 0 || !history.is_running)
    facts.last_words = LastLineOf(TailOf(output));
  return facts;
}

}  // namespace

SessionFacts ReadSession(const std::filesystem::path& folder, std::time_t now) {
  SessionFacts facts;
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  if (!error) facts.num_free_bytes = static_cast<std::int64_t>(space.available);
  // supervisord takes its file away when it ends by itself.
  const std::filesystem::path pid_file = folder / "supervisord.pid";
  facts.is_supervised = std::filesystem::exists(pid_file, error);
  if (!facts.is_supervised) return facts;
  facts.supervisor = StateOf(pid_file);
  auto histories = ReadSupervisorLog(TailOf(folder / "supervisord.log"));
  for (const std::string& name : ProgramsOf(TailOf(folder / "supervisor.conf"))) histories[name];
  for (const auto& [name, history] : histories) {
    facts.programs[name] = FactsOf(history, folder / (name + ".txt"), now);
  }
  if (facts.programs.count(kRecorder) != 0) facts.num_recorded_bytes = NewestRecordingBytes(folder);
  return facts;
}

}  // namespace voqcal
