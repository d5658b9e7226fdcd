// A thread in the background that loads, prepares or writes, with an OpenGL context of its own, so
// that the window never waits. Jobs run one after another; what comes of them is handed over on the
// main thread, when it asks.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "viewer/window.hpp"

namespace tureen::viewer {

/// Of each kind the newest counts: a job replaces the waiting one of its kind and abandons that
/// which runs. Only what is to be written waits its turn.
enum class JobKind { scene, dataset, drawing, debug_view, comparison, writing };

class Worker {
 public:
  /// Runs on the main thread, when collect() is called.
  using Completion = std::function<void()>;
  /// Says how far the job is, 0..1. Throws what ends the job where it was abandoned.
  using Progress = std::function<void(double)>;
  struct Job {
    JobKind kind;
    std::string what;                                 // for the progress bar: "reading soup.glb"
    std::function<Completion(const Progress&)> work;  // runs in the background; may throw
    std::function<void(const std::string& reason)> failed;  // what work threw; on the main thread
  };

  /// `window` must outlive it; `context` is which of its hidden ones is this thread's.
  Worker(const Window& window, int context);
  /// Abandons what runs and waits for it.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void start(Job job);
  void abandon(JobKind kind);
  /// Completes what is done.
  void collect();

  struct Status {
    std::string what;
    double fraction = 0;
    JobKind kind = JobKind::scene;
  };
  /// Of the running job; nothing when idle.
  std::optional<Status> status() const;
  /// Nothing runs, waits or wants to be collected.
  bool idle() const;

 private:
  void drop(JobKind kind);  // with the lock held
  void run();
  void run(Job& job);
  void report(double fraction);

  const Window& window_;
  int context_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Job> waiting_;
  std::optional<Status> running_;
  bool abandoned_ = false;  // what runs
  bool ending_ = false;
  struct Done {
    JobKind kind;
    Completion completion;
  };
  std::vector<Done> done_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace tureen::viewer
