#include "jobs/training/first_gaussians.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"

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

TrainingView small_view(const Photograph& photograph, const Config& config, const Region& region) {
  TrainingView view =
      trainer::training_view(photograph, std::span<const float, 3>(config.background));
  while (std::int64_t(view.camera.width) * view.camera.height > max_pixels &&
         std::min(view.camera.width, view.camera.height) >= 2 * min_side)
    view = trainer::halved(view);
  view.camera = trainer::relative_to(view.camera, region.center);
  return view;
}

GaussianConfig constants(const Config& config) {
  GaussianConfig constants;
  constants.steps = std::min(config.gaussian_steps, max_steps_ratio * config.steps);
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

Scene first_gaussians(const Dataset& dataset, const Config& config, Region region, int threads,
                      const std::function<void(double fraction)>& progress) {
  if (config.box > 0) region.half_side = config.box;
  std::vector<TrainingView> views;
  for (const Photograph& photograph : dataset.train) {
    if (progress) progress(0);
    views.push_back(small_view(photograph, config, region));
  }
  const GaussianConfig settings = constants(config);
  trainer::GaussianTrainer trainer(
      settings, views, {.center = glm::dvec3(0), .half_side = region.half_side}, threads,
      trainer::first_splats<trainer::GaussianTraining>(dataset, settings, region));
  while (!trainer.done()) {
    if (progress) progress(double(trainer.steps_done()) / settings.steps);
    trainer.step();
  }
  return scene_of(trainer.primitives(), region.center);
}

}  // namespace tureen
