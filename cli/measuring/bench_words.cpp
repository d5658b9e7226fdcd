#include "cli/measuring/bench_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tureen::cli {

std::string count_text(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string ratio_text(double ratio, const BenchMeasurement& a, const BenchMeasurement& b) {
  const Verdict verdict = verdict_on(a.frame_ms, b.frame_ms, std::max(a.aa_spread, b.aa_spread));
  return verdict == Verdict::faster || verdict == Verdict::slower
             ? fmt::format("{:.2f}", ratio)
             : verdict_text(verdict, std::min(a.frame_ms.rounds, b.frame_ms.rounds));
}

std::string verdict_text(Verdict verdict, int rounds) {
  return verdict == Verdict::unknown ? count_text(rounds, "round") : name_of(verdict);
}

std::string slowest_percent_text(const FrameStatistics& ms, const std::string& figure) {
  return tells_slowest_percent(ms) ? figure : not_known;
}

std::string machine_text(const Machine& machine) {
  std::string text = machine.cpu + ", " + count_text(machine.cores, "core");
  if (machine.rasteriser_threads)
    text += ", " + count_text(*machine.rasteriser_threads, "rasteriser thread");
  return text;
}

}  // namespace tureen::cli
