// replay: plays a recording's sensors and commands to a running rig as fast as its modules read
// them.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/tool_main.hpp"
#include "core/expected.hpp"
#include "health/session_programs.hpp"
#include "messaging/bus.hpp"
#include "messaging/log.hpp"
#include "rig/rig.hpp"
#include "voqcal/camera_board_t.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/lidar_board_t.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

struct ReplayArgs {
  std::filesystem::path rig;
  std::filesystem::path log;
  std::optional<std::string> lcm_url;
};

/// Frames under way to a detector: it is never idle, and no socket's buffer fills.
constexpr std::size_t kMaxUnderWay = 4;
/// Frames under way to the collector, which counts them once a second: a queue holds a hundred.
constexpr std::int64_t kMaxUncounted = 60;
/// A module that was killed may take as long to be back; what it had not answered, it never will.
constexpr std::chrono::seconds kPatience{20};
/// Every module is heard within it.
constexpr std::chrono::milliseconds kFirstHearing{1500};

/// The frame's time by its sensor; or why no module can read it.
template <typename Message>
Expected<std::int64_t, std::string> UtimeOf(const LogEvent& event) {
  Message message{};
  const std::string problem = DecodeMessage(event.bytes.data(), event.bytes.size(), &message);
  if (!problem.empty()) return problem;
  return message.utime;
}

/// One sensor's frames: a detector answers each with a board or a miss, and the collectors that
/// hear it count them.
class Frames {
 public:
  void Sent(std::int64_t utime) {
    under_way_.push_back(utime);
    ++num_sent_;
  }

  void Answered(std::int64_t utime) {
    const auto found = std::find(under_way_.begin(), under_way_.end(), utime);
    if (found != under_way_.end()) under_way_.erase(under_way_.begin(), found + 1);
  }

  /// @param count  of all that came to that collector, from before the replay on.
  void Counted(const std::string& collector, std::int64_t count) {
    const auto [counter, is_new] = counters_.try_emplace(collector);
    if (is_new || count < counter->second.before) counter->second.before = count - num_sent_;
    counter->second.num_counted = count - counter->second.before;
  }

  void ForgetWhatIsUnderWay() {
    num_unanswered_ += static_cast<std::int64_t>(under_way_.size());
    under_way_.clear();
    counters_.clear();
  }

  bool MayMoreCome() const { return under_way_.size() < kMaxUnderWay && !IsCollectorBehind(); }
  bool AreAllAnswered() const { return under_way_.empty(); }
  std::int64_t num_unanswered() const { return num_unanswered_; }

 private:
  struct Counter {
    std::int64_t before = 0;
    std::int64_t num_counted = 0;
  };

  bool IsCollectorBehind() const {
    return std::any_of(counters_.begin(), counters_.end(), [this](const auto& each) {
      return num_sent_ - each.second.num_counted >= kMaxUncounted;
    });
  }

  std::deque<std::int64_t> under_way_;
  std::int64_t num_sent_ = 0;
  std::int64_t num_unanswered_ = 0;
  std::map<std::string, Counter> counters_;  ///< Of the collectors that were heard.
};

class Player {
 public:
  explicit Player(const ReplayArgs& args)
      : pairs_(LoadPairs(args.rig)), bus_(args.lcm_url.value_or(pairs_.front().lcm_url)) {
    for (const Rig& pair : pairs_) {
      const Channels& channels = pair.channels;
      passed_on_.insert(channels.camera_info);
      AddSensor<lidar_board_t>(channels.lidar_points, channels.lidar_board, &lidars_);
      AddSensor<camera_board_t>(channels.camera_image, channels.camera_board, &cameras_);
    }
    bus_.Subscribe<module_status_t>(pairs_.front().channels.module_status,
                                    Queue::kEvery,
                                    [this](const auto& m) { OnStatus(m); });
  }

  void Play(const std::filesystem::path& log) {
    const Clock::time_point end = Clock::now() + kFirstHearing;
    while (Clock::now() < end) bus_.HandleOnce(std::chrono::milliseconds(50));
    LogReader reader(log);
    std::int64_t num_played = 0;
    while (const std::optional<LogEvent> event = NextWhole(&reader)) num_played += Play(*event);
    WaitUntil([this] { return AreAllAnswered(); });
    std::printf("%lld messages played\n", static_cast<long long>(num_played));
    for (const auto& [channel, unreadable] : unreadable_) {
      std::printf("%lld %s left out, which no module could read; the first: %s\n",
                  static_cast<long long>(unreadable.num),
                  channel.c_str(),
                  unreadable.first_problem.c_str());
    }
    if (reader.num_damaged() > 0) {
      std::printf("%lld damaged places of the recording left out\n",
                  static_cast<long long>(reader.num_damaged()));
    }
    std::int64_t num_unanswered = 0;
    ForEach(
        [&num_unanswered](const Sensor& each) { num_unanswered += each.frames.num_unanswered(); });
    if (num_unanswered == 0) return;
    throw std::runtime_error(std::to_string(num_unanswered) +
                             " frames were answered by no detector: was one killed?");
  }

 private:
  struct Unreadable {
    std::int64_t num = 0;
    std::string first_problem;
  };
  struct Sensor {
    Frames frames;
    bool is_read = false;  ///< A detector is there.
  };
  using Sensors = std::map<std::string, Sensor>;  ///< By channel.

  template <typename BoardMessage>
  void AddSensor(const std::string& channel, const std::string& board_channel, Sensors* sensors) {
    const auto [sensor, is_new] = sensors->try_emplace(channel);
    if (!is_new) return;
    bus_.Subscribe<BoardMessage>(
        board_channel, Queue::kEvery, [frames = &sensor->second.frames](const BoardMessage& m) {
          frames->Answered(m.utime);
        });
  }

  template <typename Action>
  void ForEach(const Action& action) {
    for (auto* sensors : {&lidars_, &cameras_}) {
      for (auto& each : *sensors) action(each.second);
    }
  }

  bool AreAllAnswered() {
    bool are_all = true;
    ForEach([&are_all](const Sensor& each) { are_all = are_all && each.frames.AreAllAnswered(); });
    return are_all;
  }

  /// A recording may end within an event: what came before it is played.
  static std::optional<LogEvent> NextWhole(LogReader* reader) try {
    return reader->Next();
  } catch (const TruncatedLogError&) {
    return std::nullopt;
  }

  int Play(const LogEvent& event) {
    const auto lidar = lidars_.find(event.channel);
    const auto camera = cameras_.find(event.channel);
    if (event.channel == pairs_.front().channels.calib_command) {
      WaitUntil([this] { return AreAllAnswered(); });
    } else if (lidar != lidars_.end()) {
      if (!MayPlay<pointcloud2_t>(event, &lidar->second)) return 0;
    } else if (camera != cameras_.end()) {
      if (!MayPlay<image_t>(event, &camera->second)) return 0;
    } else if (passed_on_.count(event.channel) == 0) {
      return 0;  // what the recording's own modules said: the live ones say it again
    }
    bus_.PublishBytes(event.channel, event.bytes.data(), event.bytes.size());
    return 1;
  }

  /// Once there is room for a frame. @return false for one that would get no answer: nothing can
  /// read it.
  template <typename Message>
  bool MayPlay(const LogEvent& event, Sensor* sensor) {
    const auto utime = UtimeOf<Message>(event);
    if (!utime) {
      Unreadable& unreadable = unreadable_[event.channel];
      if (unreadable.num++ == 0) unreadable.first_problem = utime.error();
      return false;
    }
    if (!sensor->is_read) return true;
    WaitUntil([sensor] { return sensor->frames.MayMoreCome(); });
    sensor->frames.Sent(*utime);
    return true;
  }

  template <typename Condition>
  void WaitUntil(const Condition& is_met) {
    const Clock::time_point end = Clock::now() + kPatience;
    while (!is_met()) {
      bus_.HandleOnce(std::chrono::milliseconds(50));
      if (Clock::now() < end) continue;
      ForEach([](Sensor& each) { each.frames.ForgetWhatIsUnderWay(); });
    }
  }

  void OnStatus(const module_status_t& status) {
    const std::string module = ModuleOf(status.module);
    const bool is_detector = module == "lidar_board_detector" || module == "camera_board_detector";
    for (const channel_status_t& channel : status.channels) {
      Sensors& sensors = lidars_.count(channel.channel) != 0 ? lidars_ : cameras_;
      const auto sensor = sensors.find(channel.channel);
      if (sensor == sensors.end()) continue;
      if (is_detector) sensor->second.is_read = true;
      if (module != "sample_collector") continue;
      sensor->second.frames.Counted(
          status.module, channel.num_received + channel.num_lost + channel.num_malformed);
    }
  }

  std::vector<Rig> pairs_;
  Bus bus_;
  Sensors lidars_;
  Sensors cameras_;
  std::set<std::string> passed_on_;               ///< Channels that nobody answers.
  std::map<std::string, Unreadable> unreadable_;  ///< By channel.
};

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Plays a recording's sensors and commands to a running rig (tools/up --only the readers), as "
      "fast as its modules read them: nothing is lost.",
      "replay");
  voqcal::ReplayArgs args;
  app.add_option("rig", args.rig, "The rig file (YAML)")->required();
  app.add_option("log", args.log, "The recording (LCM log)")->required();
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Player(args).Play(args.log); });
}
