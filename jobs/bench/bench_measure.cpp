#include "jobs/bench/bench_measure.hpp"

#include <algorithm>
#include <utility>

#include "base/steady_seconds.hpp"

namespace tureen {

namespace {

/// Shorter samples would measure the wait for the device instead of drawing.
constexpr double min_sample_ms = 5;

/// Time for graphics cards to raise their clocks; negligible in a run of seconds.
constexpr double min_warm_up_seconds = 0.1;

/// Adds the hash and the file of the last timed frame.
void add_proof(BenchMeasurement& measurement, const BenchCase& bench_case,
               const MeasureOptions& options) {
  const Image8 frame = bench_case.last_frame();
  measurement.pixels_hash = pixels_hash(frame);
  if (options.keep_frame) measurement.image = options.keep_frame(measurement, frame);
}

BenchMeasurement described(const CaseResult& timed, const BenchmarkResult& result,
                           const BenchViews& views) {
  BenchMeasurement measurement;
  measurement.configuration = timed.name;
  measurement.camera_set = views.camera_set;
  measurement.size = views.size;
  measurement.width = views.cameras.front().width;
  measurement.height = views.cameras.front().height;
  measurement.views = int(views.cameras.size());
  measurement.frames_per_sample = result.frames_per_sample;
  measurement.frames = int(timed.times.ms.size()) * result.frames_per_sample;
  measurement.frame_ms = statistics_of(timed.times);
  measurement.fps = 1000 / measurement.frame_ms.mean;
  measurement.aa_spread = result.aa_spread;
  measurement.stable = timed.stable;
  measurement.views_ms = view_medians(timed.times);
  return measurement;
}

std::vector<BenchMeasurement> measure_views(const BenchCases& cases, const BenchViews& views,
                                            const BenchmarkOptions& benchmark,
                                            const MeasureOptions& options) {
  std::vector<BenchmarkCase> timed_cases;
  for (const auto& bench_case : cases.list) timed_cases.push_back(bench_case->benchmark_case());
  const BenchmarkResult result = run_benchmark(timed_cases, views.cameras, benchmark);
  std::vector<BenchMeasurement> measurements;
  for (std::size_t i = 0; i < cases.list.size(); ++i) {
    BenchCase& bench_case = *cases.list[i];
    BenchMeasurement measurement = described(result.cases[i], result, views);
    add_proof(measurement, bench_case, options);
    // Passes come last, because they draw further frames.
    PassTimes passes = bench_case.passes(views.cameras);
    measurement.passes_ms = std::move(passes.ms);
    measurement.passes_gap = passes.gap;
    measurement.passes_reason = std::move(passes.reason);
    measurement.gpu_ms = passes.gpu_ms;
    measurement.order_ms = bench_case.order_ms(views.cameras, options.clock);
    measurements.push_back(std::move(measurement));
  }
  return measurements;
}

}  // namespace

std::vector<BenchMeasurement> measure(const BenchCases& cases, const std::vector<BenchViews>& views,
                                      const MeasureOptions& options) {
  const double start = steady_seconds();
  const double count = double(views.size());
  std::vector<BenchMeasurement> measurements;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string detail = views[i].camera_set + " " + views[i].size;
    BenchmarkOptions benchmark{.rounds = options.rounds};
    benchmark.clock = options.clock;
    benchmark.min_sample_ms = cases.sort ? 0 : min_sample_ms;
    benchmark.min_warm_up_seconds = min_warm_up_seconds;
    benchmark.progress = [&](double fraction) {
      if (options.progress) options.progress((double(i) + fraction) / count, detail);
    };
    if (options.max_seconds > 0) {
      // Views that need less than their share leave time to later views, which have larger images.
      const double used = steady_seconds() - start;
      const double left = (options.max_seconds - used) / (count - double(i));
      benchmark.max_seconds = std::max(left, 1e-3);  // one round is always measured
      benchmark.max_warm_up_seconds = std::min(benchmark.max_warm_up_seconds, left / 8);
    }
    for (BenchMeasurement& each : measure_views(cases, views[i], benchmark, options))
      measurements.push_back(std::move(each));
  }
  return measurements;
}

}  // namespace tureen
