// Runs numbered pieces of work on several threads. A free thread takes the next piece.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tureen::example {

/// Calls body(i) for every i in [0, count) on up to `threads` threads. After an exception no
/// further piece begins; the first exception is rethrown when all threads have ended.
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
