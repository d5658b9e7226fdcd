#include "viewer/worker.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

#include "base/steady_seconds.hpp"

namespace tureen::viewer {

namespace {

/// Ends an abandoned job.
struct Abandoned {};

}  // namespace

Worker::Worker(const Window& window, std::optional<int> context)
    : window_(window), context_(context), thread_([this] { run(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = abandoned_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::start(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (job.kind != JobKind::writing) drop(job.kind);
    waiting_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void Worker::post(Completion completion) {
  {
    const std::lock_guard lock(mutex_);
    if (abandoned_) throw Abandoned{};
    done_.push_back({running_->kind, std::move(completion)});
  }
  Window::wake();
}

void Worker::abandon(JobKind kind) {
  const std::lock_guard lock(mutex_);
  drop(kind);
}

void Worker::drop(JobKind kind) {
  if (running_ && running_->kind == kind) abandoned_ = true;
  std::erase_if(done_, [&](const Done& done) { return done.kind == kind; });
  std::erase_if(waiting_, [&](const Job& other) { return other.kind == kind; });
}

bool Worker::collect() {
  std::vector<Done> done;
  {
    const std::lock_guard lock(mutex_);
    done = std::exchange(done_, {});
  }
  for (auto each = done.begin(); each != done.end(); ++each) try {
      each->completion();
    } catch (...) {  // the others run in the next call
      const std::lock_guard lock(mutex_);
      done_.insert(done_.begin(), std::next(each), done.end());
      throw;
    }
  return !done.empty();
}

std::optional<Worker::Status> Worker::status() const {
  const std::lock_guard lock(mutex_);
  if (abandoned_) return {};
  std::optional<Status> status = running_;
  if (status) status->seconds = steady_seconds() - began_;
  return status;
}

bool Worker::idle() const {
  const std::lock_guard lock(mutex_);
  return !running_ && waiting_.empty() && done_.empty();
}

void Worker::run() {
  if (context_) window_.make_worker_context_current(*context_);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (ending_) break;
    Job job = std::move(waiting_.front());
    waiting_.erase(waiting_.begin());
    running_ = Status{.what = job.what, .fraction = 0, .kind = job.kind};
    began_ = steady_seconds();
    abandoned_ = false;
    lock.unlock();
    run(job);
    lock.lock();
    running_.reset();
    lock.unlock();
    Window::wake();
    lock.lock();
  }
  lock.unlock();
  if (context_) window_.release_worker_context();
}

void Worker::run(Job& job) {
  Completion completion;
  try {
    completion = job.work([this](double fraction) { report(fraction); });
  } catch (const Abandoned&) {
    return;
  } catch (const std::bad_alloc&) {
    completion = [failed = job.failed] { failed("there is not enough memory"); };
  } catch (const std::exception& error) {
    completion = [failed = job.failed, reason = std::string(error.what())] { failed(reason); };
  }
  const std::lock_guard lock(mutex_);
  if (!abandoned_) done_.push_back({job.kind, std::move(completion)});
}

void Worker::report(double fraction) {
  bool shown = false;
  {
    const std::lock_guard lock(mutex_);
    if (abandoned_) throw Abandoned{};
    // The waiting window redraws its progress bar only for whole percents.
    shown = static_cast<int>(running_->fraction * 100) == static_cast<int>(fraction * 100);
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (fraction != running_->fraction) running_->moved = steady_seconds() - began_;
    running_->fraction = fraction;
  }
  if (!shown) Window::wake();
}

std::optional<double> seconds_left(const Worker::Status& status) {
  // Earlier, the forecast would jump: the first percents include opening files.
  constexpr double min_fraction = 0.03, min_seconds = 1;
  if (status.fraction < min_fraction || status.seconds < min_seconds) return {};
  // It counts down while the fraction stands still.
  const double left = status.moved * (1 - status.fraction) / status.fraction;
  const double waited = status.seconds - status.moved;
  return waited <= left ? std::optional(left - waited) : std::nullopt;
}

}  // namespace tureen::viewer
