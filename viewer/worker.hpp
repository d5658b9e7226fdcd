// A background thread with its own OpenGL context that loads, prepares or writes, so that the
// window never waits. Jobs run one after another. The main thread collects their results.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "viewer/gui/window.hpp"

namespace tureen::viewer {

/// A new job replaces the waiting job of its kind and abandons the running one. Writing jobs
/// are queued instead.
enum class JobKind {
  scene,
  dataset,
  drawing,
  debug_view,
  layers,
  comparison,
  forecast,
  writing,
  tracing,
  photographs,
  cameras
};

class Worker {
 public:
  /// Runs on the main thread, when collect() is called.
  using Completion = std::function<void()>;
  /// Reports the progress of the job, 0..1. Throws to end an abandoned job.
  using Progress = std::function<void(double)>;
  struct Job {
    JobKind kind;
    std::string what;                                 // for the progress bar: "reading soup.glb"
    std::function<Completion(const Progress&)> work;  // runs in the background; may throw
    std::function<void(const std::string& reason)> failed;  // on the main thread, if work threw
  };

  /// `window` must outlive the worker. `context`: index of the hidden context for this thread;
  /// nullopt: its jobs use no OpenGL.
  Worker(const Window& window, std::optional<int> context);
  /// Abandons the running job and waits for its end.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void start(Job job);
  /// For the running job, in its thread: a further completion, before the one that it returns.
  /// Throws to end an abandoned job.
  void post(Completion completion);
  void abandon(JobKind kind);
  /// Runs the completions of finished jobs. Returns whether there were any. If one throws, the rest
  /// is left for the next call.
  bool collect();

  struct Status {
    std::string what;
    double fraction = 0;
    JobKind kind = JobKind::scene;
    double seconds = 0;  // since the job began
    double moved = 0;    // from then to the last change of `fraction`
  };
  /// The status of the running job; nullopt if there is none, or if it is abandoned.
  std::optional<Status> status() const;
  /// No job is running, waiting or uncollected.
  bool idle() const;

 private:
  void drop(JobKind kind);  // with the lock held
  void run();
  void run(Job& job);
  void report(double fraction);

  const Window& window_;
  std::optional<int> context_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Job> waiting_;
  std::optional<Status> running_;
  double began_ = 0;        // the running job, by steady_seconds()
  bool abandoned_ = false;  // the running job
  bool ending_ = false;
  struct Done {
    JobKind kind;
    Completion completion;
  };
  std::vector<Done> done_;
  std::thread thread_;  // last: it uses all of the above
};

/// Forecast for a job, in seconds, if its progress goes on as before; nullopt while too little is
/// done for a forecast, or if the next progress is overdue.
std::optional<double> seconds_left(const Worker::Status& status);

}  // namespace tureen::viewer
