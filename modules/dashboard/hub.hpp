#pragma once

#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dashboard/server.hpp"

namespace voqcal {

/// A page on the other end of a WebSocket.
class Page {
 public:
  virtual ~Page() = default;
  /// This slot has a new frame in the hub.
  virtual void HasNew(Slot slot) = 0;
};

/// Commands on their way from the server's thread to the module's.
class CommandList {
 public:
  void Add(const PageRequest& command) {
    const std::lock_guard<std::mutex> lock(mutex_);
    // Nobody clicks so fast: more is a page gone wild, or a module that is stuck.
    if (commands_.size() < 100) commands_.push_back(command);
  }
  std::vector<PageRequest> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(commands_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<PageRequest> commands_;
};

/// What the server's connections share. For the server's thread alone, but for the commands and the
/// count of pages.
struct Hub {
  ServerOptions options;
  CommandList commands;
  std::array<FramePtr, kNumSlots> newest;
  std::map<std::string, StaticFile> exports;
  std::set<Page*> pages;
  int num_requests = 0;  ///< That are being read or answered.
  std::atomic<int> num_pages{0};
};

}  // namespace voqcal
