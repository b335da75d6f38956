// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace watertight::geometry {
namespace {

class Crew {
 public:
  Crew(std::size_t count, const std::function<void(std::size_t, bool)>& work)
      : count_(count), work_(work) {}

  void start(unsigned helpers) {
    for (unsigned i = 0; i < helpers; ++i) {
      try {
        threads_.emplace_back([this] { help(); });
      } catch (const std::system_error&) {
        return;  // the threads that have started do the work
      }
    }
  }

  /// Does pieces of the work, on the thread that calls, until none is left.
  void take_part(bool is_caller) {
    try {
      for (std::size_t i = next_++; i < count_; i = next_++) work_(i, is_caller);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = count_;
    }
  }

  void wait_for_others(const std::function<void()>& wait) {
    std::unique_lock lock(mutex_);
    constexpr std::chrono::milliseconds kInterval{5};
    while (finished_ < threads_.size()) {
      has_finished_.wait_for(lock, kInterval);
      if (!wait || failure_) continue;
      lock.unlock();
      call(wait);
      lock.lock();
    }
  }

  void end() {
    for (std::thread& thread : threads_) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void help() {
    take_part(false);
    const std::lock_guard lock(mutex_);
    ++finished_;
    has_finished_.notify_one();
  }

  void call(const std::function<void()>& wait) {
    try {
      wait();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = count_;
    }
  }

  const std::size_t count_;
  const std::function<void(std::size_t, bool)>& work_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::condition_variable has_finished_;
  std::size_t finished_ = 0;    // the number of finished helpers; mutex_ guards it
  std::exception_ptr failure_;  // the first exception; mutex_ guards it
  std::vector<std::thread> threads_;
};

}  // namespace

void for_each_piece(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t, bool)>& work,
                    const std::function<void()>& wait) {
  const auto useful = static_cast<unsigned>(std::min<std::size_t>(threads, count));
  if (useful < 2) {
    for (std::size_t i = 0; i < count; ++i) work(i, true);
    return;
  }
  Crew crew(count, work);
  crew.start(useful - 1);
  crew.take_part(true);
  crew.wait_for_others(wait);
  crew.end();
}

}  // namespace watertight::geometry
