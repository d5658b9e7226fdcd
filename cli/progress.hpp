// How far long work has come: a bar on a terminal, a plain line now and then elsewhere, nothing
// for work that is done at once.
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

namespace tureen::cli {

class Progress {
 public:
  struct Output {
    std::FILE* stream = stderr;
    bool terminal = false;
    std::function<double()> seconds;  // a clock that never goes back
    double line_seconds = 5;          // between plain lines: few fill a log, and leave no doubt
  };
  /// Standard error and the steady clock.
  static Output standard_error();

  /// `task` such as "reading soup.glb".
  explicit Progress(std::string task, Output output = standard_error());
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Wipes the bar.
  ~Progress();

  /// Fraction done, 0..1, and what else there is to say. Cheap enough to call often. Throws
  /// Interrupted after Ctrl-C.
  void update(double fraction, const std::string& detail = {});

 private:
  void draw_bar(double fraction, const std::string& detail);

  std::string task_;
  Output output_;
  double start_;
  double last_ = 0;
  bool shown_ = false;
};

/// "7 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace tureen::cli
