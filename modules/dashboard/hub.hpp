#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
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
  /// This slot of this pair has a new frame in the hub.
  virtual void HasNew(Slot slot, std::size_t pair) = 0;
};

/// Commands on their way from the server's thread to the module's.
class CommandList {
 public:
  /// @return false if it was refused: more wait than anybody clicks, so a page has gone wild or the
  /// module is stuck.
  bool Add(const PageRequest& command) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (commands_.size() >= kMaxWaiting) {
      ++num_refused_;
      return false;
    }
    commands_.push_back(command);
    return true;
  }
  std::vector<PageRequest> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(commands_, {});
  }
  std::int64_t num_refused() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return num_refused_;
  }

 private:
  static constexpr std::size_t kMaxWaiting = 100;

  mutable std::mutex mutex_;
  std::vector<PageRequest> commands_;
  std::int64_t num_refused_ = 0;
};

/// What there is to show of a pair.
struct PairInHub {
  std::array<FramePtr, kNumSlots> newest;
  std::map<std::string, StaticFile> exports;
  std::atomic<int> num_pages{0};
};

/// What the server's connections share. For the server's thread alone, but for the commands and the
/// counts of pages.
struct Hub {
  explicit Hub(const ServerOptions& options_in)
      : options(options_in), pairs(options.pairs.size()) {}

  ServerOptions options;
  CommandList commands;
  std::vector<PairInHub> pairs;
  std::set<Page*> pages;
  int num_requests = 0;  ///< That are being read or answered.
  std::atomic<int> num_pages{0};
};

}  // namespace voqcal
