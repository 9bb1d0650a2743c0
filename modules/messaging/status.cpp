#include "messaging/status.hpp"

#include <utility>

#include "messaging/session_name.hpp"
#include "messaging/wall_clock.hpp"

namespace voqcal {

StatusPublisher::StatusPublisher(Bus& bus,
                                 std::string channel,
                                 const std::filesystem::path& session_dir,
                                 std::string name)
    : bus_(bus),
      channel_(std::move(channel)),
      session_(SessionName(session_dir)),
      name_(std::move(name)) {}

void StatusPublisher::Publish(const Module& module,
                              const std::string& state,
                              Clock::time_point now) {
  module_status_t message{};
  message.utime = WallClockUs();
  message.seq = ++num_sent_;
  message.module = name_.empty() ? module.Name() : name_;
  message.session = session_;
  message.state = state;
  std::int64_t num_foreign = 0;
  for (const auto& [name, counts] : bus_.channels()) {
    num_foreign += counts.num_foreign;
    channel_status_t channel{};
    channel.channel = name;
    channel.num_received = counts.num_received;
    channel.num_lost = counts.num_lost;
    channel.num_malformed = counts.num_malformed;
    channel.rate_hz = RateHz(name, counts.num_received, now);
    message.channels.push_back(channel);
  }
  message.num_channels = static_cast<std::int32_t>(message.channels.size());
  message.num_published = bus_.num_published();
  message.num_publish_failures = bus_.num_publish_failures();
  for (const auto& [name, count] : module.counters()) {
    counter_t counter{};
    counter.name = name;
    counter.count = count;
    message.counters.push_back(counter);
  }
  if (num_foreign > 0) {
    counter_t counter{};
    counter.name = "messages of another session";
    counter.count = num_foreign;
    message.counters.push_back(counter);
  }
  message.num_counters = static_cast<std::int32_t>(message.counters.size());
  last_ = now;
  bus_.Publish(channel_, message);
}

double StatusPublisher::RateHz(const std::string& channel,
                               std::int64_t num_received,
                               Clock::time_point now) {
  const std::int64_t num_new = num_received - std::exchange(num_received_[channel], num_received);
  const double elapsed_s = std::chrono::duration<double>(now - last_).count();
  if (num_sent_ == 1 || elapsed_s <= 0.0) return 0.0;
  return static_cast<double>(num_new) / elapsed_s;
}

}  // namespace voqcal
