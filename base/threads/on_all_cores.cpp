#include "base/threads/on_all_cores.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

namespace tureen {

void on_all_cores(
    std::size_t count, const std::function<void(double)>& progress,
    const std::function<void(std::size_t i, const std::function<void(double)>& check)>& work) {
  struct Abandoned {};
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> cancelled = false;
  const auto check = [&](double) {
    if (cancelled) throw Abandoned();
  };
  const auto run = [&] {
    for (std::size_t i; (i = next++) < count && !cancelled; ++done) try {
        work(i, check);
      } catch (const Abandoned&) {
        return;
      } catch (...) {
        cancelled = true;
        throw;
      }
  };
  std::vector<std::future<void>> threads;
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  try {
    for (std::size_t i = 0; i < std::min(cores, count); ++i)
      threads.push_back(std::async(std::launch::async, run));
    for (std::future<void>& thread : threads) {
      do progress(double(done) / double(count));
      while (thread.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready);
      thread.get();
    }
  } catch (...) {
    cancelled = true;  // destroying the futures waits for the threads
    throw;
  }
}

}  // namespace tureen
