#include "cli/progress.hpp"

#include <algorithm>
#include <utility>

#ifdef _WIN32
#include <io.h>
#define isatty _isatty
#define fileno _fileno
#else
#include <unistd.h>
#endif

#include "cli/interrupt.hpp"

namespace tureen::cli {

namespace {

// Work shorter than this shows nothing; bars are redrawn ten times a second; logs get a line
// every five seconds, which neither fills them nor leaves anybody in doubt.
constexpr double quiet_seconds = 0.5, bar_seconds = 0.1, line_seconds = 5;

int percent(double fraction) { return int(std::clamp(fraction, 0.0, 1.0) * 100); }

}  // namespace

Progress::Output Progress::standard_error() {
  return {stderr, isatty(fileno(stderr)) != 0, [] {
            const auto now = std::chrono::steady_clock::now().time_since_epoch();
            return std::chrono::duration<double>(now).count();
          }};
}

Progress::Progress(std::string task, Output output)
    : task_(std::move(task)), output_(std::move(output)), start_(output_.seconds()) {}

Progress::~Progress() {
  if (shown_ && output_.terminal) std::fputs("\r\033[K", output_.stream);
}

void Progress::update(double fraction) {
  throw_if_interrupted();
  const double now = output_.seconds();
  const double pause = output_.terminal ? (shown_ ? bar_seconds : quiet_seconds) : line_seconds;
  if (now - (shown_ ? last_ : start_) < pause) return;
  last_ = now;
  shown_ = true;
  if (output_.terminal)
    draw_bar(fraction);
  else
    std::fprintf(output_.stream, "%s: %d %%\n", task_.c_str(), percent(fraction));
  std::fflush(output_.stream);
}

void Progress::draw_bar(double fraction) {
  constexpr int width = 30;
  const int full = percent(fraction) * width / 100;
  std::fprintf(output_.stream, "\r%s [%s%s] %d %%\033[K", task_.c_str(),
               std::string(std::size_t(full), '#').c_str(),
               std::string(std::size_t(width - full), '.').c_str(), percent(fraction));
}

}  // namespace tureen::cli
