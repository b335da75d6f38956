// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace watertight {

void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& step) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> has_failed = false;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&]() noexcept {
    try {
      for (std::size_t i = next++; i < count && !has_failed; i = next++) step(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      has_failed = true;
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  const std::size_t helper_count =
      count == 0 ? 0 : std::min(std::max<std::size_t>(threads, 1), count) - 1;
  helpers.reserve(helper_count);
  try {
    for (std::size_t i = 0; i < helper_count; ++i) helpers.emplace_back(work);
  } catch (const std::system_error&) {
    // No more threads are to be had: those there are do the work.
  }
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace watertight
