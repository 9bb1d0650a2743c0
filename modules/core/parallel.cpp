#include "core/parallel.hpp"

#include <system_error>

namespace voqcal {

Helpers& Helpers::Shared() {
  static Helpers helpers(std::max(1U, std::thread::hardware_concurrency()) - 1);
  return helpers;
}

Helpers::Helpers(std::size_t num) { SetNum(num); }

Helpers::~Helpers() { Stop(); }

void Helpers::SetNum(std::size_t num) {
  Stop();
  is_at_end_ = false;
  try {
    while (threads_.size() < num) threads_.emplace_back([this] { Help(); });
  } catch (const std::system_error&) {
    // Those that there are do it all.
  }
}

void Helpers::Share(const std::function<void()>& work, std::size_t most) {
  std::list<SharedWork> own = {{&work, std::min(most, num())}};
  const auto shared = own.begin();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    all_.splice(all_.end(), own);
  }
  if (most > 1) {
    there_is_work_.notify_all();
  } else {
    there_is_work_.notify_one();
  }
  work();
  std::unique_lock<std::mutex> lock(mutex_);
  shared->num_wanted = 0;
  work_has_ended_.wait(lock, [&] { return shared->num_at_work == 0; });
  all_.erase(shared);
}

void Helpers::Stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_at_end_ = true;
  }
  there_is_work_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void Helpers::Help() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    there_is_work_.wait(lock, [this] { return is_at_end_ || FirstWanted() != nullptr; });
    SharedWork* shared = FirstWanted();
    if (shared == nullptr) return;
    --shared->num_wanted;
    ++shared->num_at_work;
    lock.unlock();
    (*shared->work)();
    lock.lock();
    if (--shared->num_at_work == 0) work_has_ended_.notify_all();
  }
}

Helpers::SharedWork* Helpers::FirstWanted() {
  for (SharedWork& shared : all_) {
    if (shared.num_wanted > 0) return &shared;
  }
  return nullptr;
}

}  // namespace voqcal
