#include "jobs/bench/bench_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tureen {

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
    return fmt::format("{}, {}, {}", r.scene.name,
                       primitives_text(r.scene.triangles, r.scene.splats), r.scene.appearance);
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

}  // namespace tureen
