#include "jobs/training/photograph_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/input.hpp"
#include "image/png.hpp"
#include "jobs/training/first_gaussians.hpp"
#include "scene/region.hpp"
#include "scene/upper_median.hpp"
#include "trainer/common/random.hpp"

namespace tureen {

namespace {

/// Of an image: below this, it shows too little of an object.
constexpr double least_pixels = 30'000;
constexpr double least_scale = 0.125;

/// A part of a step's time goes to the splats, whatever the size of the images: as for so many
/// pixels. Lego with 60,000 splats at the end, in a minute: 404 steps at 0.5, 945 at 0.125.
constexpr double pixels_of_splats = 50'000;

int wanted_steps(const FullPhotographs& full, const TrainingMethodInfo& method) {
  return full.of_an_object ? method.least_steps / 4 : method.least_steps;
}

Dataset noise() {
  constexpr int size = 256, views = 4;
  Dataset dataset;
  trainer::Random random(1);
  for (int view = 0; view < views; ++view) {
    const double turn = 1.57 * view;
    Photograph& photograph = dataset.train.emplace_back();
    photograph.camera =
        look_at({4 * std::cos(turn), 4 * std::sin(turn), 1}, {0, 0, 0}, {0, 0, 1}, 0.7, size, size);
    Image8 image(size, size);
    for (glm::u8vec4& pixel : image.pixels)
      pixel = glm::u8vec4(glm::u8vec3(random.below(256)), 255);
    photograph.image = std::move(image);
  }
  return dataset;
}

}  // namespace

double TimeForSteps::of_step(double scale) const {
  return seconds_per_pixel * (pixels * scale * scale + pixels_of_splats);
}

double scale_for(const TimeForSteps& time) {
  double scale = 1;
  while (time.steps * time.of_step(scale) > time.seconds && scale > least_scale &&
         time.pixels * scale * scale / 4 >= least_pixels)
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
  return upper_median(std::move(times)) /
         (double(dataset.train.front().image.pixels()) + pixels_of_splats);
}

FullPhotographs full_photographs(const std::filesystem::path& dataset, DatasetOptions options) {
  options.part = DatasetPart::train;
  options.scale = 1;
  FullPhotographs full;
  for (const DatasetSummary::View& view : read_dataset_summary(dataset, options).train)
    full.cameras.push_back(view.camera);
  try {
    Input file = Input::open(dataset / full.cameras.front().name);
    for (const glm::u8vec4& pixel : read_image(file).pixels) full.of_an_object |= pixel.a < 255;
  } catch (const InputError&) {  // the name is that of a file in another folder: of a place
  }
  return full;
}

FullPhotographs full_photographs(const std::vector<Photograph>& train) {
  FullPhotographs full;
  for (const Photograph& each : train) full.cameras.push_back(each.camera);
  full.of_an_object = !train.front().image.is_opaque();
  return full;
}

double moderate_scale(std::span<const Camera> cameras) {
  constexpr double most = 1000;
  int longer = 1;
  for (const Camera& camera : cameras) longer = std::max({longer, camera.width, camera.height});
  return std::min(1.0, std::floor(1e4 * most / longer) / 1e4);
}

std::optional<TrainingForecast> forecast_of(const TrainingLength& length,
                                            std::optional<double> scale,
                                            const FullPhotographs& full,
                                            const TrainingMethodInfo& method,
                                            double seconds_per_pixel) {
  if (!(length.minutes > 0 || length.steps > 0)) return {};
  TimeForSteps time{.seconds = 60 * length.minutes,
                    .seconds_per_pixel = seconds_per_pixel * method.cost_of_pixel,
                    .steps = wanted_steps(full, method)};
  for (const Camera& camera : full.cameras)
    time.pixels += double(camera.width) * camera.height / double(full.cameras.size());
  TrainingForecast forecast{.minutes = length.minutes, .steps = length.steps};
  forecast.scale = scale.value_or(length.minutes > 0 ? scale_for(time) : 1);
  const double step = time.of_step(forecast.scale);
  if (length.minutes > 0)
    forecast.steps = time.seconds / step;
  else
    forecast.minutes = length.steps * step / 60;
  return forecast;
}

std::optional<OwnFact> too_few_steps(double steps, const FullPhotographs& full,
                                     const TrainingMethodInfo& method) {
  const double needed = std::max(double(full.cameras.size()), wanted_steps(full, method) / 4.0);
  if (steps >= needed) return {};
  return OwnFact{"too_few_steps", needed,
                 fmt::format("{} from {} leave the scene blurred; it needs at least {}: give more "
                             "minutes, or smaller photographs",
                             counted(std::uint64_t(std::max(0.0, steps)), "step"),
                             counted(full.cameras.size(), "photograph"),
                             counted(std::uint64_t(std::ceil(needed))))};
}

double one_digit(double value) {
  const double unit = std::pow(10, std::floor(std::log10(std::max(value, 1e-9))));
  return std::round(value / unit) * unit;
}

PhotographSize photographs_for(double minutes, const FullPhotographs& full,
                               const TrainingMethodInfo& method, double seconds_per_pixel) {
  const TrainingForecast forecast =
      *forecast_of({.minutes = minutes}, {}, full, method, seconds_per_pixel);
  return {.scale = forecast.scale,
          .note = {
              "scale_for_minutes", forecast.scale,
              fmt::format("{:g} min allow about {} steps at --scale {:g} of the photographs, "
                          "the size of this training; --scale chooses another",
                          minutes, counted(std::uint64_t(std::max(one_digit(forecast.steps), 1.0))),
                          forecast.scale)}};
}

}  // namespace tureen
