#include "health/heartbeats.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace voqcal {
namespace {

// Heartbeats come once a second: two that got lost are no alarm.
constexpr double kSilenceS = 3.0;

std::int64_t NumReceived(const HeardModule* heard, const std::string& channel) {
  if (heard == nullptr) return 0;
  for (const channel_status_t& each : heard->status.channels) {
    if (each.channel == channel) return each.num_received;
  }
  return 0;
}

/// Two sessions that run it mix what they send or keep. Who only watches (extrinsic_monitor) or
/// shows (the pages of two pairs of one rig) mixes nothing.
bool MixesSessions(const std::string& name) {
  const std::string module = ModuleOf(name);
  return !module.empty() && module != "dashboard" && module != "pose_guide";
}

/// Those lately heard, but for `own`: "a and of b"; and how many.
std::pair<std::string, int> SessionsText(const std::map<std::string, HeardModule::Time>& sessions,
                                         const std::set<std::string>& own,
                                         HeardModule::Time now) {
  std::pair<std::string, int> text{"", 0};
  for (const auto& [session, at] : sessions) {
    if (own.count(session) != 0 || SecondsBetween(at, now) > kSilenceS) continue;
    text.first += (text.second++ == 0 ? "" : " and of ") + session;
  }
  return text;
}

Stream StreamOf(const std::string& channel, const std::string& sender, const std::string& name) {
  Stream stream;
  stream.channel = channel;
  stream.sender = sender;
  stream.name = name;
  return stream;
}

Stream DetectorStream(const std::string& channel,
                      const std::string& module,
                      const std::string& input) {
  Stream stream = StreamOf(channel, module, module);
  stream.input = input;
  return stream;
}

}  // namespace

SessionPlan PlanOfPair(const Channels& channels) {
  return {AllModuleNames(),
          {StreamOf(channels.lidar_points, "lidar_driver", "lidar"),
           StreamOf(channels.camera_image, "camera_driver", "camera"),
           DetectorStream(channels.lidar_board, "lidar_board_detector", channels.lidar_points),
           DetectorStream(channels.camera_board, "camera_board_detector", channels.camera_image)},
          {}};
}

SessionPlan PlanOfRig(const std::filesystem::path& rig, const std::vector<Rig>& pairs) {
  if (pairs.size() == 1) return PlanOfPair(pairs.front().channels);
  SessionPlan plan;
  for (const SessionProgram& program : ProgramsOfRig(rig)) {
    plan.modules.push_back(program.name);
    if (!program.folder.empty()) plan.folders.push_back(program.folder);
  }
  std::vector<Stream> detectors;
  std::set<std::string> told;
  for (const Rig& pair : pairs) {
    const std::string& lidar = pair.lidar_name;
    const std::string& camera = pair.camera_name;
    const Channels& channels = pair.channels;
    if (told.insert(lidar).second) {
      plan.streams.push_back(
          StreamOf(channels.lidar_points, "lidar_driver_" + lidar, "lidar " + lidar));
      detectors.push_back(DetectorStream(
          channels.lidar_board, "lidar_board_detector_" + lidar, channels.lidar_points));
    }
    if (told.insert(camera).second) {
      plan.streams.push_back(
          StreamOf(channels.camera_image, "camera_driver_" + camera, "camera " + camera));
      detectors.push_back(DetectorStream(
          channels.camera_board, "camera_board_detector_" + camera, channels.camera_image));
    }
  }
  plan.streams.insert(plan.streams.end(), detectors.begin(), detectors.end());
  return plan;
}

double SecondsBetween(HeardModule::Time from, HeardModule::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

bool HeardModule::HasEnded() const { return status.state == "done" || status.state == "stopped"; }

bool HeardModule::IsSilent(Time now) const { return SecondsBetween(at, now) > kSilenceS; }

const HeardModule* Heartbeats::Find(const std::string& module) const {
  const auto found = heard_.find(module);
  return found == heard_.end() ? nullptr : &found->second;
}

void Heartbeats::Take(const module_status_t& status, Time now) {
  if (status.state == kToBeStarted) {
    to_be_started_[status.module][status.session] = now;
    return;
  }
  HeardModule heard{status, now};
  const HeardModule* before = Find(status.module);
  if (before != nullptr) {
    const bool is_same = status.session == before->status.session;
    const bool is_restarted = is_same && status.seq <= before->status.seq;
    heard.num_restarts = before->num_restarts + (is_restarted ? 1 : 0);
    heard.sessions = before->sessions;
    const double elapsed_s = SecondsBetween(before->at, now);
    if (is_same && !is_restarted && elapsed_s > 0) {
      heard.published_hz =
          static_cast<double>(status.num_published - before->status.num_published) / elapsed_s;
    }
    if (!is_same || is_restarted) before = nullptr;  // its counts began anew
  }
  NoteNews(status, before, now);
  NoteLosses(status, before, now);
  heard.sessions[status.session] = now;
  if (heard.HasEnded()) heard.sessions.erase(status.session);
  heard_[status.module] = std::move(heard);
}

void Heartbeats::NoteNews(const module_status_t& status, const HeardModule* before, Time now) {
  for (Stream& stream : streams_) {
    for (const channel_status_t& channel : status.channels) {
      if (channel.channel != stream.channel) continue;
      const std::int64_t num_new = channel.num_received - NumReceived(before, channel.channel);
      stream.has_reader = true;
      // What the first heartbeat counts may have come long ago.
      stream.has_come_before = stream.has_come_before || channel.num_received > 0;
      const bool is_news = before != nullptr ? num_new > 0 : channel.rate_hz > 0;
      if (!is_news) continue;
      if (before != nullptr) {
        const double reported_s = SecondsBetween(before->at, now) / static_cast<double>(num_new);
        const double since_s = stream.has_come ? SecondsBetween(stream.last_news, now) : 0.0;
        const double gap_s = num_new > 1 ? reported_s : std::max(reported_s, since_s);
        stream.usual_gap_s = 0.5 * (stream.usual_gap_s + gap_s);
      }
      stream.has_come = true;
      stream.last_news = now;
    }
  }
}

void Heartbeats::NoteLosses(const module_status_t& status, const HeardModule* before, Time now) {
  const auto sum = [](const module_status_t& of) {
    std::int64_t num_lost = 0;
    for (const channel_status_t& channel : of.channels) num_lost += channel.num_lost;
    return num_lost;
  };
  // What the first heartbeat counts may have been lost long ago.
  if (before != nullptr && sum(status) > sum(before->status)) last_loss_ = now;
}

std::vector<std::string> Heartbeats::Rivals(Time now,
                                            const std::string& own,
                                            const std::vector<std::string>& folders) const {
  const int least = own.empty() ? 2 : 1;
  std::set<std::string> all_own;
  if (!own.empty()) all_own.insert(own);
  for (const std::string& folder : folders) all_own.insert(own + "/" + folder);
  std::vector<std::string> rivals;
  for (const auto& [module, heard] : heard_) {
    if (!MixesSessions(module)) continue;
    const auto [names, num] = SessionsText(heard.sessions, all_own, now);
    if (num >= least) rivals.push_back(module + " of " + names + " runs on this network");
  }
  for (const auto& [module, sessions] : to_be_started_) {
    if (!MixesSessions(module)) continue;
    const auto [names, num] = SessionsText(sessions, all_own, now);
    if (num >= least) {
      rivals.push_back(module + " of " + names + " is about to be started on this network");
    }
  }
  return rivals;
}

std::string Heartbeats::Losses() const {
  std::string text;
  for (const auto& [module, heard] : heard_) {
    for (const channel_status_t& channel : heard.status.channels) {
      if (channel.num_lost == 0) continue;
      text += (text.empty() ? "" : "; ") + module + ": " + std::to_string(channel.num_lost) +
              " of " + std::to_string(channel.num_lost + channel.num_received) + " " +
              channel.channel;
    }
  }
  return text;
}

}  // namespace voqcal
