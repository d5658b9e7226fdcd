#include "trainer/splats/splat_forecast.hpp"

#include <algorithm>
#include <cmath>

#include "trainer/common/stopwatch.hpp"
#include "trainer/splats/gaussians/gaussian_method.hpp"
#include "trainer/splats/windows/window_method.hpp"

namespace tureen::trainer {

namespace {

/// Estimates: pairs of a splat and a tile, and planes of floats for each pixel of the largest
/// image. tests/bench/splat_steps.cpp prints the number of pairs, which is larger at the start
/// and in large images.
constexpr double pairs_a_splat = 12;
constexpr double planes_a_pixel = 12;

/// The program, its libraries, and the buffers of its threads.
constexpr double program_bytes = 64.0 * (1 << 20);

constexpr std::uint64_t min_splats = 1000;

std::uint64_t pixels_of(const std::vector<Photograph>& photographs) {
  std::uint64_t pixels = 0;
  for (const Photograph& view : photographs)
    pixels += std::uint64_t(view.camera.width) * std::uint64_t(view.camera.height);
  return pixels;
}

template <class Method>
double bytes_a_splat(const SplatConfig& config) {
  using Parameters = typename Method::Parameters;
  using Raster = typename Method::Raster;
  const double rows = double(Parameters(0, config.degree).rows());
  const double trained =
      sizeof(float) * (3 * rows + double(Parameters::raw_rows + splat_statistic::count));
  const double drawn = double(Raster::Projected::bytes_a_splat + 2 * sizeof(KeyedIndex) +
                              sizeof(PairSpan) + sizeof(std::uint32_t));
  return 2 * trained + drawn +
         pairs_a_splat * double(sizeof(typename Raster::Moments) + 4 * sizeof(std::uint32_t));
}

double bytes_without_splats(const Dataset& dataset) {
  std::uint64_t largest = 0;
  for (const Photograph& view : dataset.train)
    largest =
        std::max(largest, std::uint64_t(view.camera.width) * std::uint64_t(view.camera.height));
  // Photographs have four bytes a pixel while they are read.
  return program_bytes + 4.0 * double(pixels_of(dataset.train) + pixels_of(dataset.test)) +
         planes_a_pixel * sizeof(float) * double(largest);
}

template <class Method>
std::uint64_t memory_of(const SplatConfig& config, const Dataset& dataset) {
  return std::uint64_t(bytes_without_splats(dataset) +
                       bytes_a_splat<Method>(config) * double(config.max_splats));
}

template <class Method>
std::optional<std::uint64_t> splats_within(std::uint64_t bytes, const SplatConfig& config,
                                           const Dataset& dataset) {
  const double left = double(bytes) - bytes_without_splats(dataset);
  const double fitting = std::floor(left / bytes_a_splat<Method>(config));
  if (!(fitting >= double(std::min(min_splats, config.max_splats)))) return std::nullopt;
  return std::min(config.max_splats, std::uint64_t(fitting));
}

template <class Method>
double step_seconds(typename Method::Config probe, std::span<const TrainingView> views,
                    const Region& region, int threads,
                    const SplatState<typename Method::Parameters>& state) {
  constexpr int max_steps = 20;
  constexpr double enough = 0.5;  // seconds
  probe.steps = state.step + max_steps + 1;
  probe.densify_until = 0;
  probe.half_size_until = 0;
  SplatTrainer<Method> trainer(probe, views, region, threads, state);
  trainer.step();  // allocates
  double seconds = 0;
  int steps = 0;
  for (; steps < max_steps && seconds < enough; ++steps) {
    const Stopwatch watch(seconds);
    trainer.step();
  }
  return seconds / steps;
}

}  // namespace

std::uint64_t splat_memory(const GaussianConfig& config, const Dataset& dataset) {
  return with_training(config, [&]<class Method>() { return memory_of<Method>(config, dataset); });
}

std::uint64_t splat_memory(const WindowConfig& config, const Dataset& dataset) {
  return memory_of<WindowTraining>(config, dataset);
}

std::optional<std::uint64_t> max_splats_within(std::uint64_t bytes, const GaussianConfig& config,
                                               const Dataset& dataset) {
  return with_training(
      config, [&]<class Method>() { return splats_within<Method>(bytes, config, dataset); });
}

std::optional<std::uint64_t> max_splats_within(std::uint64_t bytes, const WindowConfig& config,
                                               const Dataset& dataset) {
  return splats_within<WindowTraining>(bytes, config, dataset);
}

double measured_step_seconds(const GaussianConfig& config, std::span<const TrainingView> views,
                             const Region& region, int threads, const GaussianState& state) {
  return with_training(config, [&]<class Method>() {
    return step_seconds<Method>(config, views, region, threads, state);
  });
}

double measured_step_seconds(const WindowConfig& config, std::span<const TrainingView> views,
                             const Region& region, int threads, const WindowState& state) {
  WindowConfig soft = config;
  soft.opaque = false;  // the schedule of the probe would make the windows opaque
  return step_seconds<WindowTraining>(soft, views, region, threads, state);
}

double remaining_work(const SplatConfig& config, int done) {
  const double full_from = std::max(config.half_size_until * config.steps, double(done));
  return half_size_work * (full_from - done) + (config.steps - full_from);
}

double growth_of_work(const SplatConfig& config, int done, std::size_t count) {
  const int every = densify_interval(config);
  double now = double(std::max<std::size_t>(count, 1)), work = 0, sum = 0;
  const double first = now, last = std::max(now, double(config.max_splats));
  for (int step = done; step < config.steps;) {
    const int next = std::min((step / every + 1) * every, config.steps);
    const double part = remaining_work(config, step) - remaining_work(config, next);
    work += part;
    sum += part * now;
    if (densifies_after(config, next)) now = std::min(last, now * (1 + config.growth));
    step = next;
  }
  return work > 0 ? sum / (work * first) : 1;
}

int fitted_steps(const SplatConfig& config, int done, double seconds, double step_seconds) {
  const double work = seconds / std::max(step_seconds, 1e-6), half = config.half_size_until;
  // remaining_work() of this many steps is `work`.
  double steps = (work + half_size_work * done) / (half_size_work * half + 1 - half);
  if (half * steps < done) steps = done + work;
  return int(std::clamp(std::round(steps), double(done) + 1, 1e7));
}

}  // namespace tureen::trainer
