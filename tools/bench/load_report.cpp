#include "bench/load_report.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include "core/format.hpp"

namespace voqcal {
namespace {

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(
      values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

/// Resident memory, proc(5).
double MemoryMb(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/statm");
  double pages = 0;
  double resident = 0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Time on all cores, user and kernel, proc(5): fields 14 and 15, after the name in brackets.
double CpuS(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  std::string text;
  std::getline(file, text, '\0');
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0.0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0;
  double kernel = 0;
  fields >> user >> kernel;
  return (user + kernel) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Least-squares slope of numbers that are a second apart, for a minute.
double SlopePerMinute(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (n < 2) return 0.0;
  double sum_ty = 0;
  double sum_tt = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) - (n - 1) / 2;
    sum_ty += t * values[i];
    sum_tt += t * t;
  }
  return 60.0 * sum_ty / sum_tt;
}

}  // namespace

void SensorLoad::Answer(std::int64_t sent_utime, std::int64_t now_us) {
  latencies_ms.push_back(1e-3 * static_cast<double>(now_us - sent_utime));
}

std::int64_t SensorLoad::NumUnanswered() const {
  return num_sent - static_cast<std::int64_t>(latencies_ms.size());
}

std::string SensorLoad::Text() const {
  return Format("%lld sent, %lld unanswered, latency p50 %.1f p99 %.1f max %.1f ms\n",
                static_cast<long long>(num_sent),
                static_cast<long long>(NumUnanswered()),
                Quantile(latencies_ms, 0.5),
                Quantile(latencies_ms, 0.99),
                Quantile(latencies_ms, 1.0));
}

LoadReport::LoadReport(const std::vector<std::string>& watched) : own_start_cpu_s_(CpuS("self")) {
  for (const std::string& each : watched) {
    const std::size_t at = each.find('=');
    if (at != std::string::npos) watched_.push_back({each.substr(0, at), each.substr(at + 1), {}});
  }
}

void LoadReport::ReadMemoryIfDue() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_read_) return;
  next_read_ = now + std::chrono::seconds(1);
  for (Watched& each : watched_) {
    each.memory_mb.push_back(MemoryMb(each.pid));
    each.cpu_s = CpuS(each.pid);
  }
}

std::int64_t LoadReport::NumUnanswered() const {
  std::int64_t num = 0;
  for (const auto& [name, sensor] : sensors_) num += sensor.NumUnanswered();
  return num;
}

std::int64_t LoadReport::NumLost() const {
  std::int64_t num_lost = NumUnanswered();
  for (const auto& [module, status] : statuses_) {
    for (const channel_status_t& channel : status.channels) {
      num_lost += channel.num_lost + channel.num_malformed;
    }
  }
  return num_lost;
}

std::string LoadReport::Text() const {
  std::string text;
  for (const auto& [name, sensor] : sensors_)
    text += Format("%-12s ", name.c_str()) + sensor.Text();
  for (const auto& [module, status] : statuses_) {
    for (const channel_status_t& channel : status.channels) {
      if (channel.num_lost + channel.num_malformed == 0) continue;
      text += Format("lost    %s: %lld of %s\n",
                     module.c_str(),
                     static_cast<long long>(channel.num_lost + channel.num_malformed),
                     channel.channel.c_str());
    }
  }
  const double elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  double cores = 0.0;
  for (const Watched& each : watched_) {
    cores += each.cpu_s / elapsed_s;
    if (each.memory_mb.empty()) continue;
    // The first half fills buffers.
    const std::vector<double> second_half(
        each.memory_mb.begin() + static_cast<std::ptrdiff_t>(each.memory_mb.size() / 2),
        each.memory_mb.end());
    text += Format("%-22s %.0f MB, %+.2f MB a minute; %.1f %% of a core\n",
                   each.name.c_str(),
                   each.memory_mb.back(),
                   SlopePerMinute(second_half),
                   100 * each.cpu_s / elapsed_s);
  }
  return text + Format("modules together: %.2f cores; their drivers, simulated here: %.2f\n",
                       cores,
                       (CpuS("self") - own_start_cpu_s_) / elapsed_s);
}

}  // namespace voqcal
