#include "cli/bench_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/bench_words.hpp"
#include "cli/table.hpp"

namespace tureen::cli {

namespace {

bool same_place(const BenchMeasurement& a, const BenchMeasurement& b) {
  return a.configuration == b.configuration && a.camera_set == b.camera_set && a.size == b.size &&
         a.width == b.width && a.height == b.height;
}

const BenchMeasurement* find(const BenchResult& result, const BenchMeasurement& like) {
  const auto found =
      std::find_if(result.measurements.begin(), result.measurements.end(),
                   [&](const BenchMeasurement& each) { return same_place(each, like); });
  return found == result.measurements.end() ? nullptr : &*found;
}

std::string described(const BenchMeasurement& m) {
  const std::string pixels = fmt::format("{}x{}", m.width, m.height);
  return fmt::format("{}, {}, {}", m.configuration, m.camera_set,
                     m.size == pixels ? pixels : m.size + " (" + pixels + ")");
}

BenchRatio ratio_of(const BenchMeasurement& now, const BenchMeasurement& then) {
  BenchRatio result{.configuration = now.configuration,
                    .camera_set = now.camera_set,
                    .size = now.size,
                    .then_ms = then.frame_ms.min_of_medians,
                    .now_ms = now.frame_ms.min_of_medians};
  result.ratio = result.then_ms > 0 ? result.now_ms / result.then_ms : 1;
  const double aa_spread = std::max(now.aa_spread, then.aa_spread);
  result.spread = spread_between(now.frame_ms, then.frame_ms, aa_spread);
  result.verdict = verdict_on(now.frame_ms, then.frame_ms, aa_spread);
  result.rounds = std::min(now.frame_ms.rounds, then.frame_ms.rounds);
  result.same_pixels = now.pixels_hash == then.pixels_hash;
  return result;
}

std::vector<std::string> circumstances_of(const BenchResult& now, const BenchResult& then) {
  std::vector<std::string> result;
  const auto compare = [&](const char* what, const std::string& a, const std::string& b) {
    if (a != b) result.push_back(fmt::format("{}: {} then, {} now", what, b, a));
  };
  const auto scene = [](const BenchResult& r) {
    return fmt::format("{}, {} triangles, {}", r.scene.name, counted(r.scene.triangles),
                       r.scene.appearance);
  };
  const auto machine = [](const BenchResult& r) {
    return fmt::format("{}, {} cores", r.machine.cpu, r.machine.cores);
  };
  const auto driver = [](const BenchResult& r) {
    return r.device.renderer + ", " + r.device.version;
  };
  compare("another scene", scene(now), scene(then));
  compare("another machine", machine(now), machine(then));
  compare("another driver", driver(now), driver(then));
  compare("another context", now.device.context, then.device.context);
  if (now.machine.rasteriser_threads && then.machine.rasteriser_threads)
    compare("another number of rasteriser threads", std::to_string(*now.machine.rasteriser_threads),
            std::to_string(*then.machine.rasteriser_threads));
  if (!now.program.build.empty() && !then.program.build.empty())
    compare("another build", now.program.build, then.program.build);
  compare("another commit", now.program.commit, then.program.commit);
  compare("another clock", now.protocol.clock, then.protocol.clock);
  return result;
}

/// Why no time of the one says anything of the other's; empty where it may.
std::string incomparable(const BenchResult& now, const BenchResult& then) {
  if (now.device.software != then.device.software)
    return "not compared: one of the two was drawn in software";
  if (now.protocol.clock != then.protocol.clock)
    return "not compared: their times are of different clocks";
  return {};
}

}  // namespace

BenchComparison compare_benches(const BenchResult& now, const BenchResult& then) {
  BenchComparison result;
  const std::string reason = incomparable(now, then);
  if (!reason.empty()) result.circumstances.push_back(reason);
  for (std::string& other : circumstances_of(now, then))
    result.circumstances.push_back(std::move(other));
  if (!reason.empty()) return result;
  for (const BenchMeasurement& measurement : now.measurements)
    if (const BenchMeasurement* other = find(then, measurement))
      result.ratios.push_back(ratio_of(measurement, *other));
    else
      result.unmatched.push_back("only now: " + described(measurement));
  for (const BenchMeasurement& measurement : then.measurements)
    if (!find(now, measurement)) result.unmatched.push_back("only then: " + described(measurement));
  return result;
}

std::vector<BenchRatio> slower_than(const BenchComparison& comparison, double percent) {
  std::vector<BenchRatio> result;
  for (const BenchRatio& ratio : comparison.ratios)
    if (ratio.verdict == Verdict::slower && ratio.ratio > 1 + percent / 100)
      result.push_back(ratio);
  return result;
}

Json to_json(const BenchComparison& comparison, const std::string& against) {
  Json ratios = Json::array();
  for (const BenchRatio& ratio : comparison.ratios)
    ratios.push_back({{"configuration", ratio.configuration},
                      {"camera_set", ratio.camera_set},
                      {"size", ratio.size},
                      {"then_ms", ratio.then_ms},
                      {"now_ms", ratio.now_ms},
                      {"ratio", ratio.ratio},
                      {"spread", ratio.spread ? Json(*ratio.spread) : Json()},
                      {"rounds", ratio.rounds},
                      {"verdict", verdict_word(ratio.verdict)},
                      {"same_pixels", ratio.same_pixels}});
  return {{"against", against},
          {"ratios", std::move(ratios)},
          {"circumstances", comparison.circumstances},
          {"unmatched", comparison.unmatched}};
}

std::vector<std::string> comparison_lines(const BenchComparison& comparison) {
  std::vector<std::string> lines;
  if (!comparison.ratios.empty()) {
    Table table(
        {"configuration", "<cameras", "<size", "ms then", "ms now", "ratio", "<", "spread", "<"});
    for (const BenchRatio& ratio : comparison.ratios)
      table.row({ratio.configuration, ratio.camera_set, ratio.size, ms_text(ratio.then_ms),
                 ms_text(ratio.now_ms), fmt::format("{:.3f}", ratio.ratio),
                 verdict_text(ratio.verdict, ratio.rounds),
                 ratio.spread ? fmt::format("{:.1f} %", 100 * *ratio.spread) : not_known,
                 ratio.same_pixels ? "" : "another picture"});
    lines = table.lines();
  }
  lines.insert(lines.end(), comparison.circumstances.begin(), comparison.circumstances.end());
  lines.insert(lines.end(), comparison.unmatched.begin(), comparison.unmatched.end());
  return lines;
}

}  // namespace tureen::cli
