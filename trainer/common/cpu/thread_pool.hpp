// Threads that work through numbered tasks. What a task computes must not depend on which thread
// runs it or when: that is how training gives the same bits with any number of threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tureen::trainer {

class ThreadPool {
 public:
  /// `threads` work at a time, the caller of run() among them; 0 means all cores.
  explicit ThreadPool(int threads = 0);
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool();

  int threads() const { return int(workers_.size()) + 1; }

  /// Calls body(0) .. body(tasks - 1), each once, in any order, and returns when all are done. The
  /// first exception that a task threw is thrown here; tasks not begun by then are skipped.
  /// Not to be called from within a task.
  void run(std::size_t tasks, const std::function<void(std::size_t)>& body);

 private:
  void work();
  void take_tasks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::size_t tasks_ = 0, next_ = 0, running_ = 0;
  std::exception_ptr failure_;
  bool stop_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace tureen::trainer
