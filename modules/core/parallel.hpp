#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

namespace voqcal {

/// Threads that help whoever shares work out. Work within shared work finds those that are idle: no
/// more are at work at once than there are, and the one that asked first. A process that forks must
/// end its child by exec or _exit: these threads are not in it.
class Helpers {
 public:
  /// Of the process: with the thread that asks, one for each core.
  static Helpers& Shared();

  /// Fewer, if the host allows no more threads.
  explicit Helpers(std::size_t num);
  ~Helpers();
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  std::size_t num() const { return threads_.size(); }
  /// While nobody shares work: for tests, as what is computed must not depend on it.
  void SetNum(std::size_t num);

  /// Calls `work` here and, as long as it goes on here, on up to `most` of those that are idle.
  /// @param work  must not throw.
  void Share(const std::function<void()>& work, std::size_t most);

 private:
  struct SharedWork {
    const std::function<void()>* work;
    std::size_t num_wanted;
    std::size_t num_at_work = 0;
  };

  void Stop();
  void Help();
  SharedWork* FirstWanted();

  std::vector<std::thread> threads_;
  std::mutex mutex_;  // of what follows
  std::condition_variable there_is_work_;
  std::condition_variable work_has_ended_;
  std::list<SharedWork> all_;
  bool is_at_end_ = false;
};

/// Calls `work(i)` for each i below `num`, here and on those of the Shared() helpers that are idle,
/// but never on more than `most_at_once` threads. What each call gives must depend on i alone and
/// be stored by i: the result is then the same each time.
/// @throws what the first call (by i) that throws does, after all have ended.
template <typename Work>
void ParallelFor(std::size_t num,
                 const Work& work,
                 std::size_t most_at_once = std::numeric_limits<std::size_t>::max()) {
  std::vector<std::exception_ptr> errors(num);
  std::atomic<std::size_t> next{0};
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < num; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  const std::size_t num_at_once = std::min(num, most_at_once);
  if (num_at_once > 1) {
    Helpers::Shared().Share(take_turns, num_at_once - 1);
  } else {
    take_turns();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace voqcal
