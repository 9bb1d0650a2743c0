#include "rig_status/status_page.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

#include "core/format.hpp"

namespace voqcal {
namespace {

// Heartbeats come once a second: two that got lost are no alarm.
constexpr std::chrono::seconds kSilence{3};
constexpr std::size_t kMaxEvents = 5;
constexpr std::size_t kMaxCounters = 4;

bool StartsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// A module that said so is gone for good, not silent.
bool HasEnded(const module_status_t& status) {
  return status.state == "done" || status.state == "stopped";
}

double SecondsBetween(StatusPage::Time from, StatusPage::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

std::string ChannelText(const channel_status_t& channel) {
  std::string text = Format("    reads %-22s %6.1f Hz  %8lld received",
                            channel.channel.c_str(),
                            channel.rate_hz,
                            static_cast<long long>(channel.num_received));
  if (channel.num_lost != 0) {
    text += Format("  %lld LOST", static_cast<long long>(channel.num_lost));
  }
  if (channel.num_malformed != 0) {
    text += Format("  %lld MALFORMED", static_cast<long long>(channel.num_malformed));
  }
  return text + '\n';
}

/// "    counts 78 boards, 12 too few points": the most frequent first.
std::string CountersText(std::vector<counter_t> counters) {
  if (counters.empty()) return {};
  std::stable_sort(counters.begin(), counters.end(), [](const counter_t& a, const counter_t& b) {
    return a.count > b.count;
  });
  std::string text = "    counts";
  for (std::size_t i = 0; i < std::min(counters.size(), kMaxCounters); ++i) {
    text += (i == 0 ? " " : ", ") + std::to_string(counters[i].count) + " " + counters[i].name;
  }
  if (counters.size() > kMaxCounters) text += ", ...";
  return text + '\n';
}

std::string EventText(const event_t& event) {
  std::string text = "    " + event.kind;
  if (event.sample_id != 0) text += " sample " + std::to_string(event.sample_id);
  if (!event.reason.empty()) text += ": " + event.reason;
  return text + '\n';
}

}  // namespace

std::vector<std::string> AllModuleNames() {
  std::istringstream names(VOQCAL_MODULES);  // modules/names.txt
  return {std::istream_iterator<std::string>(names), {}};
}

StatusPage::StatusPage(std::vector<std::string> modules, std::vector<std::string> ended)
    : modules_(std::move(modules)), ended_(std::move(ended)) {}

void StatusPage::Take(const module_status_t& status, Time now) {
  const auto found = heard_.find(status.module);
  Heard heard{status, now};
  if (found != heard_.end()) {
    const Heard& before = found->second;
    const bool is_same = status.session == before.status.session;
    const bool is_restarted = is_same && status.seq <= before.status.seq;
    heard.num_restarts = before.num_restarts + (is_restarted ? 1 : 0);
    const double elapsed_s = SecondsBetween(before.at, now);
    if (is_same && !is_restarted && elapsed_s > 0) {
      heard.published_hz =
          static_cast<double>(status.num_published - before.status.num_published) / elapsed_s;
    }
  }
  if (found != heard_.end()) heard.sessions = found->second.sessions;
  heard.sessions[status.session] = now;
  if (HasEnded(status)) heard.sessions.erase(status.session);
  heard_[status.module] = std::move(heard);
}

void StatusPage::Take(const event_t& event) {
  events_.push_back(event);
  if (events_.size() > kMaxEvents) events_.pop_front();
}

StatusPage::Health StatusPage::HealthOf(const std::string& module, Time now) const {
  const auto found = heard_.find(module);
  if (found == heard_.end()) {
    return IsKnownToHaveEnded(module) ? Health::kGood : Health::kSilent;
  }
  const Heard& heard = found->second;
  if (StartsWith(heard.status.state, "failed")) return Health::kFailed;
  if (HasEnded(heard.status)) return Health::kGood;
  return now - heard.at > kSilence ? Health::kSilent : Health::kGood;
}

bool StatusPage::IsAllGood(Time now) const {
  if (!Rivals(now).empty() || !LostText().empty()) return false;
  return std::all_of(modules_.begin(), modules_.end(), [this, now](const std::string& module) {
    return HealthOf(module, now) == Health::kGood;
  });
}

std::string StatusPage::Text(Time now) const {
  std::string text;
  for (const std::string& module : modules_) text += ModuleText(module, now);
  for (const auto& [module, heard] : heard_) {
    const bool is_listed = std::find(modules_.begin(), modules_.end(), module) != modules_.end();
    if (!is_listed) text += ModuleText(module, now);
  }
  if (!events_.empty()) text += "last events\n";
  for (const event_t& event : events_) text += EventText(event);
  for (const std::string& rival : Rivals(now)) text += "TWO SESSIONS  " + rival + '\n';
  const std::string lost = LostText();
  return text + "silent  " + SilentText(now) + "\nlost    " + (lost.empty() ? "nothing" : lost) +
         '\n';
}

std::vector<std::string> StatusPage::Rivals(Time now, const std::string& own) const {
  std::vector<std::string> rivals;
  for (const auto& [module, heard] : heard_) {
    std::vector<std::string> sessions = SessionsOf(heard, now);
    sessions.erase(std::remove(sessions.begin(), sessions.end(), own), sessions.end());
    if (sessions.size() < (own.empty() ? 2U : 1U)) continue;
    std::string names;
    for (const std::string& session : sessions)
      names += (names.empty() ? "" : " and of ") + session;
    rivals.push_back(module + " of " + names + " runs on this network");
  }
  return rivals;
}

std::vector<std::string> StatusPage::SessionsOf(const Heard& heard, Time now) const {
  std::vector<std::string> sessions;
  for (const auto& [session, at] : heard.sessions) {
    if (now - at <= kSilence) sessions.push_back(session);
  }
  return sessions;
}

std::string StatusPage::ModuleText(const std::string& module, Time now) const {
  const auto found = heard_.find(module);
  if (found == heard_.end()) {
    return Format("%-22s %s\n", module.c_str(), IsKnownToHaveEnded(module) ? "done" : "not heard");
  }
  const Heard& heard = found->second;
  std::string text = Format("%-22s %s", module.c_str(), heard.status.state.c_str());
  if (HealthOf(module, now) == Health::kSilent) {
    text += Format("  SILENT for %.0f s", SecondsBetween(heard.at, now));
  }
  if (heard.num_restarts != 0) text += Format("  restarted %d times", heard.num_restarts);
  text += Format("\n    sends %29.1f Hz  %8lld sent",
                 heard.published_hz,
                 static_cast<long long>(heard.status.num_published));
  if (heard.status.num_publish_failures != 0) {
    text += Format("  %lld FAILED", static_cast<long long>(heard.status.num_publish_failures));
  }
  text += '\n';
  for (const channel_status_t& channel : heard.status.channels) text += ChannelText(channel);
  return text + CountersText(heard.status.counters);
}

bool StatusPage::IsKnownToHaveEnded(const std::string& module) const {
  return std::find(ended_.begin(), ended_.end(), module) != ended_.end();
}

std::string StatusPage::SilentText(Time now) const {
  std::string text;
  for (const std::string& module : modules_) {
    if (HealthOf(module, now) != Health::kSilent) continue;
    text += (text.empty() ? "" : ", ") + module;
  }
  return text.empty() ? "nobody" : text;
}

std::string StatusPage::LostText() const {
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
