#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <thread>
#include <vector>

#include <system_error>

namespace voqcal {

/// Calls `work(i)` for each i below `num`, on as many threads as the machine has cores, but never
/// more than `most_at_once`. What each call gives must depend on i alone and be stored by i: the
/// result is then the same each time.
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
  const std::size_t num_threads =
      std::min<std::size_t>({num, most_at_once, std::max(1U, std::thread::hardware_concurrency())});
  std::vector<std::thread> threads;
  try {
    for (std::size_t i = 1; i < num_threads; ++i) threads.emplace_back(take_turns);
  } catch (const std::system_error&) {
    // The host allows no more: those that there are do it all.
  }
  take_turns();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace voqcal
