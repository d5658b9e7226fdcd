#include "cli/bench_measure.hpp"

#include <chrono>

#include "cli/picture_file.hpp"
#include "cli/progress.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// Samples shorter than this would measure how one waits for a device rather than how it draws.
constexpr double least_sample_ms = 5;

/// For graphics cards to raise their clocks; next to nothing beside a run of seconds.
constexpr double least_warm_up_seconds = 0.1;

/// "tureen_hemisphere-8_1280x720.png".
std::string picture_name_of(const BenchMeasurement& measurement) {
  std::string name =
      measurement.configuration + "_" + measurement.camera_set + "_" + measurement.size;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '.') c = '-';
  return name + ".png";
}

/// What the pixels of the last frame that was timed prove.
void add_proof(BenchMeasurement& measurement, const Contestant& contestant,
               const fs::path& folder) {
  const Image8 frame = contestant.last_frame();
  measurement.pixels_hash = pixels_hash(frame);
  if (folder.empty()) return;
  const fs::path path = folder / picture_name_of(measurement);
  write_picture(frame, path);
  measurement.picture = path.string();
}

BenchMeasurement described(const EntrantResult& entrant, const BenchmarkResult& result,
                           const BenchViews& views) {
  BenchMeasurement measurement;
  measurement.configuration = entrant.name;
  measurement.camera_set = views.camera_set;
  measurement.size = views.size;
  measurement.width = views.cameras.front().width;
  measurement.height = views.cameras.front().height;
  measurement.views = int(views.cameras.size());
  measurement.frames_per_sample = result.frames_per_sample;
  measurement.frames = int(entrant.times.ms.size()) * result.frames_per_sample;
  measurement.frame_ms = statistics_of(entrant.times);
  measurement.fps = 1000 / measurement.frame_ms.mean;
  measurement.aa_spread = result.aa_spread;
  measurement.stable = entrant.stable;
  measurement.views_ms = view_medians(entrant.times);
  return measurement;
}

std::vector<BenchMeasurement> measure_views(const Contestants& contestants, const BenchViews& views,
                                            const BenchmarkOptions& options,
                                            const fs::path& folder) {
  std::vector<Entrant> entrants;
  for (const auto& contestant : contestants.list) entrants.push_back(contestant->entrant());
  const BenchmarkResult result = run_benchmark(entrants, views.cameras, options);
  std::vector<BenchMeasurement> measurements;
  for (std::size_t i = 0; i < contestants.list.size(); ++i) {
    Contestant& contestant = *contestants.list[i];
    BenchMeasurement measurement = described(result.entrants[i], result, views);
    add_proof(measurement, contestant, folder);
    // Only now: these frames are not those that were timed.
    PassTimes passes = contestant.passes(views.cameras);
    measurement.passes_ms = std::move(passes.ms);
    measurement.passes_reason = std::move(passes.reason);
    measurement.gpu_ms = passes.gpu_ms;
    measurements.push_back(std::move(measurement));
  }
  return measurements;
}

}  // namespace

std::vector<BenchMeasurement> measure(const Contestants& contestants,
                                      const std::vector<BenchViews>& views,
                                      const MeasureOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const double count = double(views.size());
  Progress progress("timing");
  std::vector<BenchMeasurement> measurements;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string detail = views[i].camera_set + " " + views[i].size;
    BenchmarkOptions benchmark{.rounds = options.rounds};
    benchmark.clock = options.clock;
    benchmark.least_sample_ms = least_sample_ms;
    benchmark.least_warm_up_seconds = least_warm_up_seconds;
    benchmark.progress = [&](double fraction) {
      progress.update((double(i) + fraction) / count, detail);
    };
    if (options.most_seconds > 0) {
      // What small pictures leave of their share is the larger ones', which come later.
      const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start;
      const double left = (options.most_seconds - used.count()) / (count - double(i));
      benchmark.most_seconds = std::max(left, 1e-3);  // a round is always made
      benchmark.most_warm_up_seconds = std::min(benchmark.most_warm_up_seconds, left / 8);
    }
    for (BenchMeasurement& each : measure_views(contestants, views[i], benchmark, options.folder))
      measurements.push_back(std::move(each));
  }
  return measurements;
}

}  // namespace tureen::cli
