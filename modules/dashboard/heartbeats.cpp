#include "dashboard/heartbeats.hpp"

#include <nlohmann/json.hpp>

#include "dashboard/slot.hpp"

namespace voqcal {
namespace {

constexpr std::chrono::seconds kSilence{3};  // of a heartbeat each second

std::string HealthOf(const std::string& state, std::chrono::steady_clock::duration age) {
  if (state.compare(0, 6, "failed") == 0) return "failed";
  const bool has_ended = state == "stopped" || state == "done";
  return age > kSilence && !has_ended ? "silent" : "good";
}

}  // namespace

void Heartbeats::Take(const module_status_t& status, Time now) {
  heard_[status.module] = {status, now};
}

std::string Heartbeats::Json(Time now) const {
  nlohmann::json json = {{"kind", ToString(Slot::kModules)}, {"modules", nlohmann::json::array()}};
  for (const auto& [name, heard] : heard_) {
    std::int64_t num_lost = 0;
    for (const channel_status_t& channel : heard.status.channels) num_lost += channel.num_lost;
    json["modules"].push_back({{"name", name},
                               {"state", heard.status.state},
                               {"health", HealthOf(heard.status.state, now - heard.at)},
                               {"num_lost", num_lost}});
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace voqcal
