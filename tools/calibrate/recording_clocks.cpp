#include "calibrate/recording_clocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "core/format.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kNumLookedAt = 20;                   // of each sensor
constexpr std::int64_t kMaxBytes = std::int64_t{1} << 28;  // of a recording that lacks one of them
constexpr double kMaxApartS = 10.0;
constexpr double kMaxLogApartS = 0.1;  // of log times, from a sweep to the nearest image
constexpr std::size_t kUtimeAt = 8;    // in an encoded message, behind the type's hash

double Seconds(std::int64_t us) { return 1e-6 * static_cast<double>(us); }

double StampMinusLogS(const std::vector<RecordedTime>& messages) {
  std::vector<double> differences_s;
  for (const RecordedTime& message : messages) {
    differences_s.push_back(Seconds(message.utime - message.log_utime));
  }
  return Median(differences_s);
}

// How far from the nearest image a sweep was recorded, at the median.
double LogTimesApartS(const std::vector<RecordedTime>& lidar,
                      const std::vector<RecordedTime>& camera) {
  std::vector<double> nearest_s;
  for (const RecordedTime& sweep : lidar) {
    double least_s = std::numeric_limits<double>::infinity();
    for (const RecordedTime& image : camera) {
      least_s = std::min(least_s, std::abs(Seconds(image.log_utime - sweep.log_utime)));
    }
    nearest_s.push_back(least_s);
  }
  return Median(nearest_s);
}

bool StandsStill(const std::vector<RecordedTime>& messages) {
  return messages.size() > 2 && messages.front().log_utime != messages.back().log_utime &&
         std::all_of(messages.begin(), messages.end(), [&messages](const RecordedTime& message) {
           return message.utime == messages.front().utime;
         });
}

std::string InWords(double seconds) {
  const std::array<std::pair<double, const char*>, 5> units = {
      {{365.25 * 86400, "years"}, {86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}}};
  for (const auto& [size_s, name] : units) {
    if (seconds >= size_s) return Format("%.3g %s", seconds / size_s, name);
  }
  return Format("%.0f ms", 1000 * seconds);
}

std::string ClockProblem(const std::vector<RecordedTime>& lidar,
                         const std::vector<RecordedTime>& camera) {
  if (StandsStill(lidar)) return "the stamps of the sweeps stand still";
  if (StandsStill(camera)) return "the stamps of the images stand still";
  const double apart_s = std::abs(StampMinusLogS(lidar) - StampMinusLogS(camera));
  if (apart_s < kMaxApartS) return {};
  return "the clocks of lidar and camera differ by " + InWords(apart_s);
}

std::int64_t UtimeOf(const LogEvent& event) {
  std::uint64_t utime = 0;
  for (std::size_t i = 0; i < 8; ++i) utime = utime << 8 | event.bytes[kUtimeAt + i];
  return static_cast<std::int64_t>(utime);
}

bool HasUtime(const LogEvent& event) { return event.bytes.size() >= kUtimeAt + 8; }

}  // namespace

ClockVerdict JudgeClocks(const std::vector<RecordedTime>& lidar,
                         const std::vector<RecordedTime>& camera) {
  if (lidar.empty() || camera.empty()) return {};
  const std::string problem = ClockProblem(lidar, camera);
  if (problem.empty()) return {};
  const double log_apart_s = LogTimesApartS(lidar, camera);
  if (log_apart_s > kMaxLogApartS) {
    return {false,
            problem + "; nor do the times at which they were recorded agree (" +
                InWords(log_apart_s) + " apart): stamps are used"};
  }
  return {true,
          problem + "; log times agree within " + InWords(log_apart_s) +
              ": using them (--times stamps forbids that). They hold for boards that are held "
              "still"};
}

ClockVerdict JudgeClocksOf(const std::filesystem::path& log, const Channels& channels) {
  std::vector<RecordedTime> lidar;
  std::vector<RecordedTime> camera;
  LogReader reader(log);
  try {
    while (reader.offset() < kMaxBytes &&
           (lidar.size() < kNumLookedAt || camera.size() < kNumLookedAt)) {
      const std::optional<LogEvent> event = reader.Next();
      if (!event) break;
      const bool is_lidar = event->channel == channels.lidar_points;
      auto& messages = is_lidar ? lidar : camera;
      if (!is_lidar && event->channel != channels.camera_image) continue;
      if (HasUtime(*event) && messages.size() < kNumLookedAt) {
        messages.push_back({UtimeOf(*event), event->utime});
      }
    }
  } catch (const TruncatedLogError&) {  // told by whoever reads the log
  }
  return JudgeClocks(lidar, camera);
}

void TakeLogTime(LogEvent* event) {
  if (!HasUtime(*event)) return;
  const auto utime = static_cast<std::uint64_t>(event->utime);
  for (std::size_t i = 0; i < 8; ++i) {
    event->bytes[kUtimeAt + i] = static_cast<std::uint8_t>(utime >> 8 * (7 - i));
  }
}

}  // namespace voqcal
