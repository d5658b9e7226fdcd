#include "cli/bench_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tureen::cli {

std::string count_text(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string reference_configuration(const BenchResult& result) {
  constexpr const char* usual = "published";
  for (const BenchMeasurement& m : result.measurements)
    if (m.configuration == usual) return usual;
  return result.measurements.empty() ? std::string() : result.measurements.front().configuration;
}

const BenchMeasurement* reference_of(const BenchResult& result,
                                     const BenchMeasurement& measurement) {
  const std::string reference = reference_configuration(result);
  for (const BenchMeasurement& m : result.measurements)
    if (m.configuration == reference && m.camera_set == measurement.camera_set &&
        m.size == measurement.size)
      return &m;
  return nullptr;
}

double times_as_fast(const BenchResult& result, const BenchMeasurement& measurement) {
  const BenchMeasurement* reference = reference_of(result, measurement);
  const double own = measurement.frame_ms.min_of_medians;
  return reference && own > 0 ? reference->frame_ms.min_of_medians / own : 0;
}

std::string times_as_fast_text(const BenchResult& result, const BenchMeasurement& measurement) {
  const BenchMeasurement* reference = reference_of(result, measurement);
  const double ratio = times_as_fast(result, measurement);
  if (!(ratio > 0)) return {};
  return reference == &measurement ? "1.00" : ratio_text(ratio, measurement, *reference);
}

std::string ratio_text(double ratio, const BenchMeasurement& a, const BenchMeasurement& b) {
  const Verdict verdict = verdict_on(a.frame_ms, b.frame_ms, std::max(a.aa_spread, b.aa_spread));
  return verdict == Verdict::faster || verdict == Verdict::slower
             ? fmt::format("{:.2f}", ratio)
             : verdict_text(verdict, std::min(a.frame_ms.rounds, b.frame_ms.rounds));
}

const char* verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::unknown:
      return "unknown";
    case Verdict::equal:
      return "equal";
    case Verdict::faster:
      return "faster";
    case Verdict::slower:
      return "slower";
  }
  return "";
}

std::string verdict_text(Verdict verdict, int rounds) {
  return verdict == Verdict::unknown ? count_text(rounds, "round") : verdict_word(verdict);
}

std::string spread_text(const FrameStatistics& ms) {
  return ms.rounds < least_rounds ? not_known : fmt::format("{:.1f} %", 100 * ms.spread);
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

std::string build_text(const BenchProgram& program) {
  return "commit " + program.commit +
         (program.build.empty() ? "" : ", " + program.build + " build");
}

}  // namespace tureen::cli
