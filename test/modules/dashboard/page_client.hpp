#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "dashboard/server.hpp"
#include "modules/dashboard/web_client.hpp"

namespace voqcal::test {

using Json = nlohmann::json;

inline ServerOptions TestOptions() {
  ServerOptions options;
  options.token = std::string(64, 'a');
  return options;
}

/// A page that is opened now, of a server with TestOptions.
inline SocketClient OpenPage(const DashboardServer& server) {
  const std::string host = "127.0.0.1:" + std::to_string(server.port());
  return {server.port(), "/" + TestOptions().token + "/socket", {host, "http://" + host}};
}

/// The next message of this kind.
inline Json Next(SocketClient* page, const std::string& kind) {
  Json json;
  do {
    json = page->ReadHeader();
  } while (json["kind"] != kind);
  return json;
}

/// Does `step` until the condition holds. @return false if it does not within a minute.
inline bool Await(const std::function<bool()>& condition, const std::function<void()>& step) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace voqcal::test
