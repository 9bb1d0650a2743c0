// replay: plays a recording's sensors and commands to a running rig as fast as its modules read
// them.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/tool_main.hpp"
#include "core/expected.hpp"
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

/// One sensor's frames: a detector answers each with a board or a miss, and the collector counts
/// them.
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

  /// @param count  of all that came to the collector, from before the replay on.
  void Counted(std::int64_t count) {
    if (!count_before_ || count < *count_before_) count_before_ = count - num_sent_;
    num_counted_ = count - *count_before_;
  }

  void ForgetWhatIsUnderWay() {
    num_unanswered_ += static_cast<std::int64_t>(under_way_.size());
    under_way_.clear();
    count_before_.reset();
  }

  bool MayMoreCome() const { return under_way_.size() < kMaxUnderWay && !IsCollectorBehind(); }
  bool AreAllAnswered() const { return under_way_.empty(); }
  std::int64_t num_unanswered() const { return num_unanswered_; }

 private:
  bool IsCollectorBehind() const {
    return count_before_ && num_sent_ - num_counted_ >= kMaxUncounted;
  }

  std::deque<std::int64_t> under_way_;
  std::int64_t num_sent_ = 0;
  std::int64_t num_unanswered_ = 0;
  std::optional<std::int64_t> count_before_;  ///< None: the collector was not heard.
  std::int64_t num_counted_ = 0;
};

class Player {
 public:
  explicit Player(const ReplayArgs& args)
      : rig_(LoadRig(args.rig)), bus_(args.lcm_url.value_or(rig_.lcm_url)) {
    const Channels& channels = rig_.channels;
    bus_.Subscribe<lidar_board_t>(
        channels.lidar_board, Queue::kEvery, [this](const auto& m) { sweeps_.Answered(m.utime); });
    bus_.Subscribe<camera_board_t>(
        channels.camera_board, Queue::kEvery, [this](const auto& m) { images_.Answered(m.utime); });
    bus_.Subscribe<module_status_t>(
        channels.module_status, Queue::kEvery, [this](const auto& m) { OnStatus(m); });
  }

  void Play(const std::filesystem::path& log) {
    const Clock::time_point end = Clock::now() + kFirstHearing;
    while (Clock::now() < end) bus_.HandleOnce(std::chrono::milliseconds(50));
    LogReader reader(log);
    std::int64_t num_played = 0;
    while (const std::optional<LogEvent> event = NextWhole(&reader)) num_played += Play(*event);
    WaitUntil([this] { return sweeps_.AreAllAnswered() && images_.AreAllAnswered(); });
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
    const std::int64_t num_unanswered = sweeps_.num_unanswered() + images_.num_unanswered();
    if (num_unanswered == 0) return;
    throw std::runtime_error(std::to_string(num_unanswered) +
                             " frames were answered by no detector: was one killed?");
  }

 private:
  struct Unreadable {
    std::int64_t num = 0;
    std::string first_problem;
  };

  /// A recording may end within an event: what came before it is played.
  static std::optional<LogEvent> NextWhole(LogReader* reader) try {
    return reader->Next();
  } catch (const TruncatedLogError&) {
    return std::nullopt;
  }

  int Play(const LogEvent& event) {
    const Channels& channels = rig_.channels;
    if (event.channel == channels.calib_command) {
      WaitUntil([this] { return sweeps_.AreAllAnswered() && images_.AreAllAnswered(); });
    } else if (event.channel == channels.lidar_points) {
      if (!MayPlay<pointcloud2_t>(event, is_lidar_read_, &sweeps_)) return 0;
    } else if (event.channel == channels.camera_image) {
      if (!MayPlay<image_t>(event, is_camera_read_, &images_)) return 0;
    } else if (event.channel != channels.camera_info) {
      return 0;  // what the recording's own modules said: the live ones say it again
    }
    bus_.PublishBytes(event.channel, event.bytes.data(), event.bytes.size());
    return 1;
  }

  /// Once there is room for a frame. @return false for one that would get no answer: nothing can
  /// read it.
  template <typename Message>
  bool MayPlay(const LogEvent& event, bool is_read, Frames* frames) {
    const auto utime = UtimeOf<Message>(event);
    if (!utime) {
      Unreadable& unreadable = unreadable_[event.channel];
      if (unreadable.num++ == 0) unreadable.first_problem = utime.error();
      return false;
    }
    if (!is_read) return true;
    WaitUntil([frames] { return frames->MayMoreCome(); });
    frames->Sent(*utime);
    return true;
  }

  template <typename Condition>
  void WaitUntil(const Condition& is_met) {
    const Clock::time_point end = Clock::now() + kPatience;
    while (!is_met()) {
      bus_.HandleOnce(std::chrono::milliseconds(50));
      if (Clock::now() < end) continue;
      sweeps_.ForgetWhatIsUnderWay();
      images_.ForgetWhatIsUnderWay();
    }
  }

  void OnStatus(const module_status_t& status) {
    is_lidar_read_ = is_lidar_read_ || status.module == "lidar_board_detector";
    is_camera_read_ = is_camera_read_ || status.module == "camera_board_detector";
    if (status.module != "sample_collector") return;
    for (const channel_status_t& channel : status.channels) {
      const std::int64_t count = channel.num_received + channel.num_lost + channel.num_malformed;
      if (channel.channel == rig_.channels.lidar_points) sweeps_.Counted(count);
      if (channel.channel == rig_.channels.camera_image) images_.Counted(count);
    }
  }

  Rig rig_;
  Bus bus_;
  Frames sweeps_;
  Frames images_;
  std::map<std::string, Unreadable> unreadable_;  ///< By channel.
  bool is_lidar_read_ = false;                    ///< A detector is there.
  bool is_camera_read_ = false;
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
