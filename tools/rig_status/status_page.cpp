#include "rig_status/status_page.hpp"

#include <algorithm>
#include <utility>

#include "core/format.hpp"
#include "rig_status/table_of_pairs.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxEvents = 5;
constexpr std::size_t kMaxCounters = 4;
// Of a page of 24 rows: 11 modules, three faults of two rows, two events.
constexpr std::size_t kBriefFaults = 3;
constexpr std::size_t kBriefEvents = 2;

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

std::string EventText(const event_t& event, const std::string& of) {
  std::string text = "    " + (of.empty() ? of : of + ": ") + event.kind;
  if (event.sample_id != 0) text += " sample " + std::to_string(event.sample_id);
  if (!event.reason.empty()) text += ": " + event.reason;
  return text + '\n';
}

std::string FaultText(const Fault& fault) {
  return (fault.is_grave ? "WRONG   " : "note    ") + fault.what +
         (fault.cause.empty() ? "" : ": " + fault.cause) + "\n        " + fault.remedy + '\n';
}

}  // namespace

StatusPage::StatusPage(const SessionPlan& plan, std::vector<std::string> modules, Time begin)
    : all_modules_(plan.modules),
      are_modules_given_(!modules.empty()),
      modules_(are_modules_given_ ? std::move(modules) : all_modules_),
      health_(plan, modules_, begin) {}

// tools/up --only starts some here; the others may be another host's, or nobody's.
void StatusPage::Take(const SessionFacts& facts, Time now) {
  health_.Take(facts, now);
  if (are_modules_given_) return;
  std::vector<std::string> started;
  for (const std::string& module : all_modules_) {
    if (facts.programs.count(module) != 0) started.push_back(module);
  }
  modules_ = started.empty() ? all_modules_ : started;
  health_.Expect(modules_);
}

void StatusPage::Take(const event_t& event, const std::string& of) {
  events_.push_back(EventText(event, of));
  if (events_.size() > kMaxEvents) events_.pop_front();
}

bool StatusPage::IsAllGood(Time now) const {
  const std::vector<Fault> faults = health_.Faults(now);
  const auto is_grave = [](const Fault& fault) { return fault.is_grave; };
  if (std::any_of(faults.begin(), faults.end(), is_grave) || !health_.heartbeats().Losses().empty())
    return false;
  return std::all_of(modules_.begin(), modules_.end(), [this, now](const std::string& module) {
    const ModuleHealth health = health_.HealthOf(module, now);
    return health == ModuleHealth::kGood || health == ModuleHealth::kEnded;
  });
}

std::string StatusPage::Text(Time now) const {
  std::string text = FaultsText(now, kBriefFaults);
  for (const std::string& module : Listed()) text += LineOf(module, now);
  if (rig_) text += TableOfPairs(*rig_);
  return text + EventsText(kBriefEvents) + LastLines(now);
}

std::string StatusPage::Details(Time now) const {
  std::string text = FaultsText(now, health_.Faults(now).size());
  for (const std::string& module : Listed()) text += LineOf(module, now) + DetailsOf(module);
  if (rig_) text += TableOfPairs(*rig_);
  return text + EventsText(kMaxEvents) + LastLines(now);
}

std::vector<std::string> StatusPage::Listed() const {
  std::vector<std::string> listed = are_modules_given_ ? modules_ : all_modules_;
  for (const auto& each : health_.heartbeats().heard()) {
    const bool is_new = std::find(listed.begin(), listed.end(), each.first) == listed.end();
    if (is_new) listed.push_back(each.first);
  }
  return listed;
}

std::string StatusPage::FaultsText(Time now, std::size_t max_faults) const {
  const std::vector<Fault> faults = health_.Faults(now);
  std::string text;
  for (std::size_t i = 0; i < std::min(faults.size(), max_faults); ++i)
    text += FaultText(faults[i]);
  if (faults.size() > max_faults) text += Format("        %zu more\n", faults.size() - max_faults);
  return text;
}

std::string StatusPage::EventsText(std::size_t max_events) const {
  if (events_.empty()) return {};
  std::string text = "last events\n";
  const std::size_t first = events_.size() - std::min(events_.size(), max_events);
  for (std::size_t i = first; i < events_.size(); ++i) text += events_[i];
  return text;
}

int StatusPage::NameWidth() const {
  std::size_t width = 22;
  for (const std::string& module : all_modules_) width = std::max(width, module.size());
  return static_cast<int>(width);
}

std::string StatusPage::LineOf(const std::string& module, Time now) const {
  const ModuleHealth health = health_.HealthOf(module, now);
  const auto found = health_.heartbeats().heard().find(module);
  if (found == health_.heartbeats().heard().end()) {
    const bool is_expected = std::find(modules_.begin(), modules_.end(), module) != modules_.end();
    const std::string how = health == ModuleHealth::kEnded ? health_.HowEnded(module)
                            : is_expected                  ? "not heard"
                                                           : "not started here, not heard";
    return Format("%-*s %s\n", NameWidth(), module.c_str(), how.c_str());
  }
  const HeardModule& heard = found->second;
  std::string text = Format("%-*s %s", NameWidth(), module.c_str(), heard.status.state.c_str());
  if (health == ModuleHealth::kSilent) {
    text += Format("  SILENT for %.0f s", std::chrono::duration<double>(now - heard.at).count());
  }
  if (heard.num_restarts != 0) text += Format("  restarted %d times", heard.num_restarts);
  return text + Format("  sends %.1f Hz\n", heard.published_hz);
}

std::string StatusPage::DetailsOf(const std::string& module) const {
  const auto found = health_.heartbeats().heard().find(module);
  if (found == health_.heartbeats().heard().end()) return {};
  const module_status_t& status = found->second.status;
  std::string text = Format("    %lld sent", static_cast<long long>(status.num_published));
  if (status.num_publish_failures != 0) {
    text += Format("  %lld FAILED", static_cast<long long>(status.num_publish_failures));
  }
  text += '\n';
  for (const channel_status_t& channel : status.channels) text += ChannelText(channel);
  return text + CountersText(status.counters);
}

std::string StatusPage::LastLines(Time now) const {
  std::string silent;
  for (const std::string& module : modules_) {
    if (health_.HealthOf(module, now) != ModuleHealth::kSilent) continue;
    silent += (silent.empty() ? "" : ", ") + module;
  }
  const std::string losses = health_.heartbeats().Losses();
  return "silent  " + (silent.empty() ? "nobody" : silent) + "\nlost    " +
         (losses.empty() ? "nothing" : losses) + '\n';
}

}  // namespace voqcal
