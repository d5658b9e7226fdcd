#include "cli/progress.hpp"

#include <algorithm>
#include <utility>

#include "base/platform/system.hpp"
#include "base/shown_text.hpp"
#include "base/steady_seconds.hpp"
#include "cli/interrupt.hpp"
#include "cli/report.hpp"

namespace tureen::cli {

namespace {

// Bars appear after 0.5 s and are redrawn ten times a second.
constexpr double quiet_seconds = 0.5, bar_seconds = 0.1;

int percent(double fraction) { return int(std::clamp(fraction, 0.0, 1.0) * 100); }

}  // namespace

std::string time_left_text(double fraction, double seconds) {
  if (seconds < 5 || !(fraction > 0)) return {};
  const double left = seconds / fraction - seconds;
  return left < 90 ? std::to_string(int(left) + 1) + " s left"
                   : std::to_string(int(left / 60) + 1) + " min left";
}

Progress::Output Progress::standard_error() {
  return {.stream = stderr, .terminal = is_terminal(stderr), .seconds = steady_seconds};
}

Progress::Progress(std::string task, Output output)
    : task_(std::move(task)), output_(std::move(output)), start_(output_.seconds()) {}

Progress::~Progress() {
  if (shown_ && output_.terminal) std::fputs("\r\033[K", output_.stream);
}

void Progress::update(double fraction, const std::string& detail) {
  throw_if_interrupted();
  if (is_quiet()) return;
  const double now = output_.seconds();
  const double pause =
      output_.terminal ? (shown_ ? bar_seconds : quiet_seconds) : output_.line_seconds;
  if (now - (shown_ ? last_ : start_) < pause) return;
  last_ = now;
  shown_ = true;
  if (output_.terminal)
    draw_bar(fraction, detail);
  else
    std::fprintf(output_.stream, "%s: %d %%%s%s\n", shown_text(task_).c_str(), percent(fraction),
                 detail.empty() ? "" : ", ", shown_text(detail).c_str());
  std::fflush(output_.stream);
}

void Progress::draw_bar(double fraction, const std::string& detail) {
  // With a detail text the bar is shorter, so that both fit 80 columns.
  const int width = detail.empty() ? 30 : 10;
  const int full = percent(fraction) * width / 100;
  const std::string text = detail.empty() ? std::to_string(percent(fraction)) + " %" : detail;
  std::fprintf(output_.stream, "\r%s [%s%s] %s\033[K", shown_text(task_).c_str(),
               std::string(std::size_t(full), '#').c_str(),
               std::string(std::size_t(width - full), '.').c_str(), shown_text(text).c_str());
}

}  // namespace tureen::cli
