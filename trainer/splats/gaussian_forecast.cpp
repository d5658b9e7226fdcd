#include "trainer/splats/gaussian_forecast.hpp"

#include <algorithm>
#include <cmath>

#include "splatting/gaussian_entries.hpp"
#include "splatting/gaussian_kernels.hpp"
#include "trainer/common/stopwatch.hpp"
#include "trainer/splats/gaussian_trainer.hpp"

namespace tureen::trainer {

namespace {

/// Estimates: pairs of a splat and a tile, and planes of floats for each pixel of the largest
/// image. tests/bench/train_gaussians.cpp prints the number of pairs, which is larger at the start
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

double bytes_a_splat(const GaussianConfig& config) {
  const double rows = double(GaussianParameters(0, config.degree).rows());
  const double trained =
      sizeof(float) * (3 * rows + double(GaussianParameters::raw_rows + splat_statistic::count));
  const double drawn = sizeof(splatting::GaussianEntry) + 2 * sizeof(KeyedIndex) +
                       sizeof(PairSpan) + sizeof(std::uint32_t);
  return 2 * trained + drawn +
         pairs_a_splat * double(sizeof(GaussianMoments) + 4 * sizeof(std::uint32_t));
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

}  // namespace

std::uint64_t gaussian_memory(const GaussianConfig& config, const Dataset& dataset) {
  return std::uint64_t(bytes_without_splats(dataset) +
                       bytes_a_splat(config) * double(config.max_splats));
}

std::optional<std::uint64_t> max_splats_within(std::uint64_t bytes, const GaussianConfig& config,
                                               const Dataset& dataset) {
  const double left = double(bytes) - bytes_without_splats(dataset);
  const double fitting = std::floor(left / bytes_a_splat(config));
  if (!(fitting >= double(std::min(min_splats, config.max_splats)))) return std::nullopt;
  return std::min(config.max_splats, std::uint64_t(fitting));
}

double measured_step_seconds(const GaussianConfig& config, std::span<const TrainingView> views,
                             const Region& region, int threads, const GaussianState& state) {
  constexpr int max_steps = 20;
  constexpr double enough = 0.5;  // seconds
  GaussianConfig probe = config;
  probe.steps = state.step + max_steps + 1;
  probe.densify_every = probe.steps + 1;
  probe.half_size_until = 0;
  GaussianTrainer trainer(probe, views, region, threads, state);
  trainer.step();  // allocates
  double seconds = 0;
  int steps = 0;
  for (; steps < max_steps && seconds < enough; ++steps) {
    const Stopwatch watch(seconds);
    trainer.step();
  }
  return seconds / steps;
}

double remaining_work(const GaussianConfig& config, int done) {
  const double full_from = std::max(config.half_size_until * config.steps, double(done));
  return half_size_work * (full_from - done) + (config.steps - full_from);
}

int fitted_steps(const GaussianConfig& config, int done, double seconds, double step_seconds) {
  const double work = seconds / std::max(step_seconds, 1e-6), half = config.half_size_until;
  // remaining_work() of this many steps is `work`.
  double steps = (work + half_size_work * done) / (half_size_work * half + 1 - half);
  if (half * steps < done) steps = done + work;
  return int(std::clamp(std::round(steps), double(done) + 1, 1e7));
}

}  // namespace tureen::trainer
