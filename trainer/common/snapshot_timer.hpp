// When a run makes snapshots for a window: at once, and then so that they take at most 3 % of the
// time.
#pragma once

#include <algorithm>

namespace tureen::trainer {

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

}  // namespace tureen::trainer
