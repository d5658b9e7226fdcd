#include "cli/bench_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

using What = BenchChange::What;

std::vector<BenchChange> changes_between(const BenchResult& now, const BenchResult& then) {
  std::vector<BenchChange> result;
  const auto compare = [&](What what, const std::string& a, const std::string& b) {
    if (a != b) result.push_back({.what = what, .then = b, .now = a});
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
  compare(What::scene, scene(now), scene(then));
  compare(What::machine, machine(now), machine(then));
  compare(What::driver, driver(now), driver(then));
  compare(What::context, now.device.context, then.device.context);
  if (now.machine.rasteriser_threads && then.machine.rasteriser_threads)
    compare(What::rasteriser_threads, std::to_string(*now.machine.rasteriser_threads),
            std::to_string(*then.machine.rasteriser_threads));
  if (!now.program.build.empty() && !then.program.build.empty())
    compare(What::build, now.program.build, then.program.build);
  compare(What::commit, now.program.commit, then.program.commit);
  if (now.protocol.processor_time != then.protocol.processor_time)
    compare(What::clock, now.protocol.clock, then.protocol.clock);
  return result;
}

std::optional<Incomparable> incomparable(const BenchResult& now, const BenchResult& then) {
  if (now.device.software != then.device.software) return Incomparable::software;
  if (now.protocol.processor_time != then.protocol.processor_time) return Incomparable::clock;
  return std::nullopt;
}

const char* name_of(Incomparable reason) {
  return reason == Incomparable::software ? "software" : "clock";
}

/// In the order of BenchChange::What, as JSON has them.
constexpr std::array<const char*, 8> change_names{
    "scene", "machine", "driver", "context", "rasteriser_threads", "build", "commit", "clock"};

std::string describe(Incomparable reason) {
  return reason == Incomparable::software ? "not compared: one of the two used a software renderer"
                                          : "not compared: the two used different clocks";
}

std::string describe(const BenchChange& change) {
  const char* what = change.what == What::rasteriser_threads
                         ? "number of rasteriser threads"
                         : change_names[std::size_t(change.what)];
  return fmt::format("different {}: {} then, {} now", what, change.then, change.now);
}

std::string describe(const UnmatchedBench& unmatched) {
  return (unmatched.in == UnmatchedBench::In::now ? "only now: " : "only then: ") +
         described(unmatched.measurement);
}

std::vector<std::string> circumstances(const BenchComparison& comparison) {
  std::vector<std::string> sentences;
  if (comparison.incomparable) sentences.push_back(describe(*comparison.incomparable));
  for (const BenchChange& change : comparison.changes) sentences.push_back(describe(change));
  return sentences;
}

std::vector<std::string> unmatched_lines(const BenchComparison& comparison) {
  std::vector<std::string> lines;
  for (const UnmatchedBench& each : comparison.unmatched) lines.push_back(describe(each));
  return lines;
}

}  // namespace

BenchComparison compare_benches(const BenchResult& now, const BenchResult& then) {
  BenchComparison result{.incomparable = incomparable(now, then),
                         .ratios = {},
                         .changes = changes_between(now, then),
                         .unmatched = {}};
  if (result.incomparable) return result;
  for (const BenchMeasurement& measurement : now.measurements)
    if (const BenchMeasurement* other = find(then, measurement))
      result.ratios.push_back(ratio_of(measurement, *other));
    else
      result.unmatched.push_back({UnmatchedBench::In::now, measurement});
  for (const BenchMeasurement& measurement : then.measurements)
    if (!find(now, measurement))
      result.unmatched.push_back({UnmatchedBench::In::then, measurement});
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
  Json changes = Json::array();
  for (const BenchChange& change : comparison.changes)
    changes.push_back({{"what", change_names[std::size_t(change.what)]},
                       {"then", change.then},
                       {"now", change.now}});
  const std::optional<Incomparable>& reason = comparison.incomparable;
  return {{"against", against},
          {"incomparable", reason ? Json(name_of(*reason)) : Json()},
          {"ratios", std::move(ratios)},
          {"changes", std::move(changes)},
          {"circumstances", circumstances(comparison)},
          {"unmatched", unmatched_lines(comparison)}};
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
                 ratio.same_pixels ? "" : "different image"});
    lines = table.lines();
  }
  for (std::string& line : circumstances(comparison)) lines.push_back(std::move(line));
  for (std::string& line : unmatched_lines(comparison)) lines.push_back(std::move(line));
  return lines;
}

}  // namespace tureen::cli
