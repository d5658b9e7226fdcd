// Threads that run numbered tasks. A task's result must not depend on the thread that runs it or on
// the time: then results have the same bits with any number of threads.
#pragma once

#include <cstddef>
#include <functional>
#ifndef __EMSCRIPTEN__
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace tureen {

#ifdef __EMSCRIPTEN__
/// Pages have one thread.
class ThreadPool {
 public:
  void run(std::size_t tasks, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = 0; i < tasks; ++i) body(i);
  }
};
#else
class ThreadPool {
 public:
  /// `threads`: number of threads, including the caller of run(); 0 means all cores.
  explicit ThreadPool(int threads = 0);
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool();

  int threads() const { return int(workers_.size()) + 1; }

  /// Calls body(0) .. body(tasks - 1), each once, in any order, and returns when all are done. It
  /// rethrows the first exception of a task and skips the tasks that have not begun by then.
  /// A task must not call it.
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
#endif

}  // namespace tureen
