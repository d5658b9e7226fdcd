#include "base/threads/thread_pool.hpp"

#include <algorithm>
#include <utility>

namespace tureen {

ThreadPool::ThreadPool(int threads) {
  if (threads <= 0) threads = int(std::max(1u, std::thread::hardware_concurrency()));
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::take_tasks(std::unique_lock<std::mutex>& lock) {
  while (next_ < tasks_) {
    const std::size_t task = next_++;
    ++running_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*body_)(task);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --running_;
    if (failure && !failure_) {
      failure_ = failure;
      next_ = tasks_;
    }
  }
}

void ThreadPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    begin_.wait(lock, [this] { return stop_ || next_ < tasks_; });
    if (stop_) return;
    take_tasks(lock);
    if (running_ == 0) end_.notify_one();
  }
}

void ThreadPool::run(std::size_t tasks, const std::function<void(std::size_t)>& body) {
  std::unique_lock lock(mutex_);
  body_ = &body;
  tasks_ = tasks;
  next_ = 0;
  begin_.notify_all();
  take_tasks(lock);
  end_.wait(lock, [this] { return running_ == 0; });
  tasks_ = next_ = 0;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace tureen
