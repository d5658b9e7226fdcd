#include "jobs/training/photograph_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/decimal_text.hpp"
#include "jobs/training/first_gaussians.hpp"
#include "scene/region.hpp"
#include "trainer/common/random.hpp"

namespace tureen {

namespace {

/// Below this, images show too little of an object.
constexpr int least_side = 100;
constexpr double least_scale = 0.125;

/// A step later in a run, with more splats, over one of the probe. Measured on a room, a bottle and
/// lego, at 0.5 to 3 minutes: 1.3 to 2.
constexpr double later_steps = 1.6;

Dataset noise() {
  constexpr int size = 256, views = 4;
  Dataset dataset;
  trainer::Random random(1);
  for (int view = 0; view < views; ++view) {
    const double turn = 1.57 * view;
    Photograph& photograph = dataset.train.emplace_back();
    photograph.camera =
        look_at({4 * std::cos(turn), 4 * std::sin(turn), 1}, {0, 0, 0}, {0, 0, 1}, 0.7, size, size);
    photograph.image = Image8(size, size, glm::u8vec4(255));
    for (glm::u8vec4& pixel : photograph.image.pixels)
      pixel = glm::u8vec4(glm::u8vec3(random.below(256)), 255);
  }
  return dataset;
}

double step_time(const TimeForSteps& time, double scale) {
  return time.seconds_per_pixel * time.pixels * scale * scale;
}

}  // namespace

double scale_for(const TimeForSteps& time) {
  double scale = 1;
  while (time.steps * step_time(time, scale) > time.seconds && scale > least_scale &&
         time.shorter_side * scale / 2 >= least_side)
    scale /= 2;
  return scale;
}

double measured_seconds_per_pixel(int threads) {
  const Dataset dataset = noise();
  FirstGaussians probe;
  probe.constants.steps = 20;
  probe.constants.half_size_until = 0;
  probe.constants.max_splats = probe.constants.first_splats;
  std::vector<double> starts;
  train_first_gaussians(dataset, probe, region_of_interest(dataset), threads, [&](double) {
    starts.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
  });
  std::vector<double> times;
  for (std::size_t i = starts.size() / 2; i < starts.size(); ++i)
    times.push_back(starts[i] - starts[i - 1]);
  std::ranges::nth_element(times, times.begin() + std::ptrdiff_t(times.size() / 2));
  return times[times.size() / 2] / double(dataset.train.front().image.pixels.size());
}

PhotographSize photographs_for(double minutes, const std::vector<Camera>& full,
                               const TrainingMethodInfo& method, double seconds_per_pixel) {
  TimeForSteps time{.seconds = 60 * minutes,
                    .shorter_side = std::numeric_limits<int>::max(),
                    .seconds_per_pixel = seconds_per_pixel * later_steps * method.cost_of_pixel,
                    .steps = method.least_steps};
  for (const Camera& camera : full) {
    time.pixels += double(camera.width) * camera.height / double(full.size());
    time.shorter_side = std::min({time.shorter_side, camera.width, camera.height});
  }
  const double scale = scale_for(time), steps = time.seconds / step_time(time, scale);
  // One digit: the forecast is no better.
  const double unit = std::pow(10, std::floor(std::log10(std::max(steps, 1.0))));
  return {.scale = scale,
          .note = {"scale_for_minutes", scale,
                   fmt::format("{:g} min allow about {} steps at --scale {:g} of the photographs, "
                               "the size of this training; --scale chooses another",
                               minutes, counted(std::uint64_t(std::round(steps / unit) * unit)),
                               scale)}};
}

}  // namespace tureen
