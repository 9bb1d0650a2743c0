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
  std::list<Shares> own = {{&work, std::min(most, num())}};
  const auto shares = own.begin();
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
  shares->num_wanted = 0;
  work_has_ended_.wait(lock, [&] { return shares->num_at_work == 0; });
  all_.erase(shares);
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
    Shares* shares = FirstWanted();
    if (shares == nullptr) return;
    --shares->num_wanted;
    ++shares->num_at_work;
    lock.unlock();
    (*shares->work)();
    lock.lock();
    if (--shares->num_at_work == 0) work_has_ended_.notify_all();
  }
}

Helpers::Shares* Helpers::FirstWanted() {
  for (Shares& shares : all_) {
    if (shares.num_wanted > 0) return &shares;
  }
  return nullptr;
}

}  // namespace voqcal
