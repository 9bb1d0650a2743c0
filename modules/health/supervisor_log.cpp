#include "health/supervisor_log.hpp"

#include <iomanip>
#include <sstream>

namespace voqcal {
namespace {

/// "2026-11-29 12:02:03,123 INFO exited: ..." is of the host's local time; -1 if it is not so.
std::time_t TimeOf(const std::string& line) {
  std::tm local{};
  std::istringstream text(line);
  text >> std::get_time(&local, "%Y-%m-%d %H:%M:%S");
  local.tm_isdst = -1;
  return text.fail() ? -1 : std::mktime(&local);
}

/// What stands between the last `open` and the `close` behind it.
std::string Between(const std::string& text, char open, const char* close) {
  const std::size_t begin = text.find(open);
  if (begin == std::string::npos) return {};
  return text.substr(begin + 1, text.find_first_of(close, begin + 1) - begin - 1);
}

void TakeEnd(const std::string& line, bool is_expected, ProgramHistory* history) {
  history->is_running = false;
  history->how_ended = Between(line, '(', ";)");
  history->has_ended_well = is_expected && history->how_ended == "exit status 0";
  if (!is_expected) history->unexpected_ends.push_back(TimeOf(line));
}

void TakeLine(const std::string& line, const std::string& event, ProgramHistory* history) {
  if (event == "spawned") {
    history->is_running = true;
    history->started = TimeOf(line);
    history->has_given_up = history->has_ended_well = history->was_stopped = false;
  } else if (event == "exited") {
    TakeEnd(line, line.find("; expected)") != std::string::npos, history);
  } else if (event == "gave up") {
    history->is_running = false;
    history->has_given_up = true;
  } else if (event == "stopped") {
    history->is_running = false;
    history->was_stopped = true;
  }
}

}  // namespace

std::map<std::string, ProgramHistory> ReadSupervisorLog(const std::string& log) {
  std::map<std::string, ProgramHistory> programs;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    for (const char* event : {"spawned", "exited", "gave up", "stopped"}) {
      const std::string mark = std::string(" ") + event + ": ";
      const std::size_t at = line.find(mark);
      if (at == std::string::npos) continue;
      std::istringstream rest(line.substr(at + mark.size()));
      std::string name;
      rest >> name;
      if (name.size() > 2 && name.front() == '\'') name = name.substr(1, name.size() - 2);
      TakeLine(line, event, &programs[name]);
    }
  }
  return programs;
}

std::vector<std::string> ProgramsOf(const std::string& supervisor_conf) {
  std::vector<std::string> programs;
  std::istringstream lines(supervisor_conf);
  const std::string mark = "[program:";
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, mark.size(), mark) != 0) continue;
    programs.push_back(line.substr(mark.size(), line.find(']') - mark.size()));
  }
  return programs;
}

}  // namespace voqcal
