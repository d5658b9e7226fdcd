// Numbered pieces of work, shared among threads: whoever is free takes the next.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tureen::example {

/// Calls body(i) for every i in [0, count) from up to `threads` threads. Rethrows the first
/// exception after all have ended; the pieces that were not begun by then are left out.
template <class Body>
void in_parallel(int count, int threads, Body body) {
  std::atomic<int> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (int i; (i = next++) < count;) body(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < threads && i < count; ++i) others.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tureen::example
