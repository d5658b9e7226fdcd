#include "trainer/splats/splat_forecast.hpp"

#include <algorithm>
#include <cmath>

#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/neural/neural_training.hpp"
#include "trainer/splats/windows/window_training.hpp"

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

template <class Config>
double bytes_a_splat(const Config& config) {
  return with_training(config, [&]<class Training>() {
    using Parameters = typename Training::Parameters;
    using Moments = typename Training::Moments;
    const double rows = double(Parameters(0, config.degree).rows());
    const double trained =
        sizeof(float) * (3 * rows + double(Parameters::raw_rows + splat_statistic::count));
    const double drawn = double(ProjectedSplats<typename Training::Kernel>::bytes_a_splat +
                                2 * sizeof(KeyedIndex) + sizeof(PairSpan) + sizeof(std::uint32_t));
    return 2 * trained + drawn +
           pairs_a_splat * double(sizeof(Moments) + 4 * sizeof(std::uint32_t));
  });
}

double bytes_without_splats(const Dataset& dataset, PhotographPlace place) {
  std::uint64_t largest = 0, photographs = 0;
  for (const auto* views : {&dataset.train, &dataset.test})
    for (const Photograph& view : *views) {
      const std::uint64_t pixels =
          std::uint64_t(view.camera.width) * std::uint64_t(view.camera.height);
      // Photographs have four bytes a pixel while they are read.
      if (place == PhotographPlace::as_now && !view.file()) photographs += 4 * pixels;
      if (views == &dataset.train) largest = std::max(largest, pixels);
    }
  return program_bytes + double(photographs) + planes_a_pixel * sizeof(float) * double(largest);
}

}  // namespace

template <class Config>
std::uint64_t splat_memory(const Config& config, const Dataset& dataset, PhotographPlace place) {
  return std::uint64_t(bytes_without_splats(dataset, place) +
                       bytes_a_splat(config) * double(config.max_splats));
}

template <class Config>
std::optional<std::uint64_t> max_splats_within(std::uint64_t bytes, const Config& config,
                                               const Dataset& dataset, PhotographPlace place) {
  const double left = double(bytes) - bytes_without_splats(dataset, place);
  const double fitting = std::floor(left / bytes_a_splat(config));
  if (!(fitting >= double(std::min(min_splats, config.max_splats)))) return std::nullopt;
  return std::min(config.max_splats, std::uint64_t(fitting));
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

template std::uint64_t splat_memory(const GaussianConfig&, const Dataset&, PhotographPlace);
template std::uint64_t splat_memory(const NeuralConfig&, const Dataset&, PhotographPlace);
template std::uint64_t splat_memory(const WindowConfig&, const Dataset&, PhotographPlace);
template std::optional<std::uint64_t> max_splats_within(std::uint64_t, const GaussianConfig&,
                                                        const Dataset&, PhotographPlace);
template std::optional<std::uint64_t> max_splats_within(std::uint64_t, const NeuralConfig&,
                                                        const Dataset&, PhotographPlace);
template std::optional<std::uint64_t> max_splats_within(std::uint64_t, const WindowConfig&,
                                                        const Dataset&, PhotographPlace);

}  // namespace tureen::trainer
