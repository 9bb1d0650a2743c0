#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dashboard/request.hpp"
#include "dashboard/slot.hpp"

namespace voqcal {

/// What a GET gives out, held in memory: no path of the network ever touches the file system.
struct StaticFile {
  std::string content_type;
  std::string bytes;
  bool is_download = false;  ///< To be saved under its name, not shown.
  bool is_one_file = false;  ///< A page with its styles and pictures: it may load and run nothing.
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< To listen at; "0.0.0.0" for every network.
  std::uint16_t port = 0;             ///< 0: any that is free.
  std::string host_name;              ///< By which the page may be opened, besides addresses.
  std::string token;                  ///< First part of every path.
  /// Names of what can be shown, one at a time on each page: the pairs of a rig.
  std::vector<std::string> pairs = {""};
  /// By their paths behind the token: "" is the page.
  std::map<std::string, StaticFile> files;
};

/// HTTP and WebSocket for the page: "/TOKEN/", "/TOKEN/dashboard.js", ..., "/TOKEN/socket".
///
/// Whoever asks must know the token and name this server in Host; a WebSocket (and whatever else
/// has an Origin) must come from this server's own page. Of each slot a page gets the newest frame
/// only, one frame at a time, and a large one only once it has drawn the last: who is slow misses
/// frames and delays nobody. Of several pairs a page sees the first until it asks for another; the
/// first frame of that is its kRig, and none of another pair follows it.
///
/// One thread of its own does all of that. The caller's thread and it meet in two places: what is
/// shown is handed over as a task of the server's queue, and the commands lie in a list under a
/// mutex.
class DashboardServer {
 public:
  /// Listens from now on.
  /// @throws std::runtime_error naming the address, the port and the cause.
  explicit DashboardServer(const ServerOptions& options);
  ~DashboardServer();
  DashboardServer(const DashboardServer&) = delete;
  DashboardServer& operator=(const DashboardServer&) = delete;

  std::uint16_t port() const;

  /// How many pages are open.
  int num_pages() const;
  /// How many of them show this pair.
  int num_pages(std::size_t pair) const;

  /// Shows this to every page of the pair, and to those that come later, in place of what the slot
  /// showed.
  void Show(Slot slot, FramePtr frame, std::size_t pair = 0);

  /// The pair's files under "export/": these and no others.
  void Offer(std::map<std::string, StaticFile> exports, std::size_t pair = 0);

  /// The commands that came since the last call, in order.
  std::vector<PageRequest> TakeCommands();

  /// How many commands were refused because too many waited to be taken.
  std::int64_t num_refused_commands() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voqcal
