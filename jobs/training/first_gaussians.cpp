#include "jobs/training/first_gaussians.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_forecast.hpp"

namespace tureen {

namespace {

using trainer::Config;
using trainer::GaussianConfig;
using trainer::TrainingView;

/// Photographs are halved until they have at most this many pixels. More pixels do not place
/// surfaces better; with these, a step takes a few milliseconds.
constexpr std::int64_t max_pixels = 1 << 17;

/// Sides are not halved below this: the training halves them once more at its start, and the loss
/// has windows of 11 pixels.
constexpr int min_side = 22;

/// More Gaussians than most soups have triangles.
constexpr std::uint64_t max_gaussians = 20'000;

/// Their steps for each step of the triangles, at most: a short run would otherwise spend most of
/// its time here. Less than 1,500 steps are too few for surfaces in the distance.
constexpr int max_steps_ratio = 3;

/// Of the minutes of a run, at most.
constexpr double share_of_time = 0.15;

TrainingView small_view(const Photograph& photograph, const FirstGaussians& first,
                        const Region& region) {
  TrainingView view =
      trainer::training_view(photograph, std::span<const float, 3>(first.constants.background));
  if (first.max_pixels > 0) view = trainer::halved_to(std::move(view), first.max_pixels, min_side);
  view.camera = trainer::relative_to(view.camera, region.center);
  if (photograph.file()) trainer::store(view, photograph.file());
  return view;
}

/// Lowers the number of steps so that the training takes this time: after 20 steps, which the
/// caches and the processor's clock need, and at each tenth up to the middle.
void fit_steps(trainer::GaussianTrainer& trainer, double seconds, double spent, double work) {
  const GaussianConfig& config = trainer.config();
  const int done = trainer.steps_done(), tenth = std::max(1, config.steps / 10);
  if (done != 20 && (done % tenth != 0 || done < 20 || done > 5 * tenth)) return;
  const std::size_t splats = trainer.parameters().count();
  const double step_seconds =
      spent / work * double(splats) * trainer::growth_of_work(config, done, splats);
  trainer.set_steps(
      std::min(config.steps, trainer::fitted_steps(config, done, seconds - spent, step_seconds)));
}

GaussianConfig constants(const Config& config) {
  GaussianConfig constants;
  constants.steps = config.minutes > 0
                        ? config.gaussian_steps
                        : std::min(config.gaussian_steps, max_steps_ratio * config.steps);
  constants.max_splats = max_gaussians;
  constants.seed = config.seed;
  std::ranges::copy(config.background, constants.background);
  constants.far_splats = config.far_points;
  constants.far_extent = config.far_extent;
  return constants;
}

}  // namespace

bool begins_with_gaussians(const Config& config, const Dataset& dataset) {
  return config.initialisation == trainer::Initialisation::automatic && config.gaussian_steps > 0 &&
         dataset.points.empty();
}

Scene train_first_gaussians(const Dataset& dataset, const FirstGaussians& first,
                            const Region& region, int threads,
                            const std::function<void(double fraction)>& progress) {
  std::vector<TrainingView> views;
  for (const Photograph& photograph : dataset.train) {
    if (progress) progress(0);
    views.push_back(small_view(photograph, first, region));
  }
  trainer::GaussianTrainer trainer(
      first.constants, views, {.center = glm::dvec3(0), .half_side = region.half_side}, threads,
      trainer::first_splats<trainer::GaussianTraining>(
          dataset, first.constants, region, nullptr, {.threads = threads, .progress = [&](double) {
                                                        if (progress) progress(0);
                                                      }}));
  double spent = 0, work = 0;  // work: in steps of full size with one splat
  while (!trainer.done()) {
    if (progress) progress(double(trainer.steps_done()) / trainer.config().steps);
    if (first.seconds > 0 && work > 0) fit_steps(trainer, first.seconds, spent, work);
    const int done = trainer.steps_done();
    work += double(trainer.parameters().count()) *
            (trainer::remaining_work(trainer.config(), done) -
             trainer::remaining_work(trainer.config(), done + 1));
    const trainer::Stopwatch watch(spent);
    trainer.step();
  }
  return scene_of(trainer.primitives(), region.center);
}

Scene first_gaussians(const Dataset& dataset, const Config& config, Region region, int threads,
                      const std::function<void(double fraction)>& progress) {
  if (config.box > 0) region.half_side = config.box;
  return train_first_gaussians(dataset,
                               {.constants = constants(config),
                                .max_pixels = max_pixels,
                                .seconds = share_of_time * 60 * config.minutes},
                               region, threads, progress);
}

}  // namespace tureen
