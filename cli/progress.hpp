// Progress of long work: a bar on a terminal, otherwise a line every few seconds. Short work prints
// nothing.
#pragma once

#include <cstdio>
#include <functional>
#include <string>

namespace tureen::cli {

/// "3 min left" for work that took `seconds` so far; empty in the first 5 s.
std::string time_left_text(double fraction, double seconds);

class Progress {
 public:
  struct Output {
    std::FILE* stream = stderr;
    bool terminal = false;
    std::function<double()> seconds;  // a monotonic clock
    double line_seconds = 5;          // between lines, where there is no terminal
  };
  /// Standard error and the steady clock.
  static Output standard_error();

  /// `task`: label of the bar, such as "reading soup.glb".
  explicit Progress(std::string task, Output output = standard_error());
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Erases the bar.
  ~Progress();

  /// `fraction`: completed part, 0..1. `detail`: text beside the bar, by default the percentage.
  /// Cheap enough to call often. Throws Interrupted after Ctrl-C.
  void update(double fraction, const std::string& detail = {});

 private:
  void draw_bar(double fraction, const std::string& detail);

  std::string task_;
  Output output_;
  double start_;
  double last_ = 0;
  bool shown_ = false;
};

}  // namespace tureen::cli
