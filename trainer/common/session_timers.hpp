// When a session makes snapshots for a window, and when it fits its number of steps to its time.
#pragma once

#include <algorithm>
#include <cmath>

#include "trainer/common/trainable.hpp"

namespace tureen::trainer {

/// Snapshots: at once, and then so that they take at most 3 % of the time.
class SnapshotTimer {
 public:
  /// Between snapshots, in seconds. The window looks for a new one every second.
  static constexpr double min_seconds = 2;
  static constexpr double max_share = 0.03;  // of the time

  /// `now`: seconds, 0 or later.
  bool due(double now) const { return now >= next_; }
  /// Notes a snapshot between these two times.
  void made(double begin, double end) {
    next_ = end + std::max(min_seconds, (end - begin) / max_share);
  }

 private:
  double next_ = 0;
};

/// Fits the number of steps to the time of the run. The schedule of a run follows the fraction of
/// the steps, so each fit also moves the schedule to where the time is. Times are seconds of the
/// whole run, over all sessions.
class TimeFit {
 public:
  /// `seconds`: of the run; 0: the number of steps stays. `now`: when this session begins.
  TimeFit(double seconds, double now)
      : seconds_(seconds), next_(now > 0 ? fits_until(now) + 1 : 0) {}

  double seconds() const { return seconds_; }
  /// Whether the number of steps may change. After that, a run that resumes has the same bits.
  bool is_pending() const { return seconds_ > 0 && next_ < fits; }
  /// The time that the run has left, never negative.
  double left(double now) const { return std::max(0.0, seconds_ - now); }

  /// After a step with this work: sets the number of steps if a fit is due.
  void after_step(Trainable& run, double work, double now) {
    if (begin_ < 0) {
      begin_ = now;
      return;
    }
    work_ += work;
    if (!is_due(run, now)) return;
    const int before = run.steps();
    int steps = run.steps_in(left(now), (now - begin_) / work_);
    // A forecast from few steps swings: an early one moves the steps by half of it.
    if (next_ > 0 && now < settles_at * seconds_ && run.steps_done() < before) {
      if (std::abs(steps - before) < small_change * before) steps = before;
      steps = int(std::sqrt(double(steps) * before));
    }
    run.set_steps(std::max(steps, run.steps_done() + 1));
    next_ = fits_until(now) + 1;
    begin_ = now;
    work_ = 0;
  }

 private:
  /// A fit at each twentieth of the time: if the last forecast is wrong by its whole length, the
  /// run still uses 95 % of its time.
  static constexpr int fits = 20;
  /// The first fit may come earlier, after as many steps as caches and the processor's clock need.
  static constexpr int first_fit_steps = 20;
  /// Until this fraction of the time, fits are damped, and a change of less than 5 % is none: the
  /// intervals of densification follow the number of steps, and would be cut short.
  static constexpr double settles_at = 0.8, small_change = 0.05;

  int fits_until(double now) const {
    return seconds_ > 0 ? int(std::min(now / seconds_, 1.0) * fits) : 0;
  }
  bool is_due(const Trainable& run, double now) const {
    if (!is_pending() || work_ <= 0 || now <= begin_) return false;
    if (run.steps_done() >= run.steps()) return true;  // long before the end of the time
    if (next_ == 0 && run.steps_done() >= first_fit_steps) return true;
    return now * fits >= std::max(next_, 1) * seconds_;
  }

  double seconds_;
  int next_;           // the twentieth at which the next fit is due; 0: the first fit
  double begin_ = -1;  // of the steps since the last fit; negative: before the first step, which
                       // allocates
  double work_ = 0;    // of these steps
};

}  // namespace tureen::trainer
