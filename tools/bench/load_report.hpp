#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// What was sent for one sensor, and when its detector answered.
struct SensorLoad {
  std::atomic<std::int64_t> num_sent{0};
  std::vector<double> latencies_ms;

  void Answer(std::int64_t sent_utime, std::int64_t now_us);
  std::int64_t NumUnanswered() const;
  /// "1200 sent, 0 unanswered, latency p50 12.0 p99 30.1 max 40.2 ms".
  std::string Text() const;
};

/// Counts, latencies and memory of one run.
class LoadReport {
 public:
  /// @param watched  NAME=PID of each module.
  explicit LoadReport(const std::vector<std::string>& watched);

  /// Counts what this sensor is sent and answered; the pointer stays valid.
  SensorLoad* AddSensor(const std::string& name) { return &sensors_[name]; }
  void Take(const module_status_t& message) { statuses_[message.module] = message; }
  /// Once a second.
  void ReadMemoryIfDue();

  std::int64_t NumUnanswered() const;
  /// Messages that a module missed or nobody answered.
  std::int64_t NumLost() const;
  std::string Text() const;

 private:
  struct Watched {
    std::string name;
    std::string pid;
    std::vector<double> memory_mb;
    double cpu_s = 0.0;
  };

  std::map<std::string, SensorLoad> sensors_;
  std::vector<Watched> watched_;
  double own_start_cpu_s_;  // of this process, before it sends anything
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_read_;
  std::map<std::string, module_status_t> statuses_;
};

}  // namespace voqcal
