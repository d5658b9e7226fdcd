// A training run of splats on posed photographs: one photograph a step. The next step depends only
// on the configuration, the views and the state; it has the same bits with any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/splat_densify.hpp"
#include "trainer/splats/splat_initialise.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/splat_state.hpp"
#include "trainer/splats/tasks.hpp"
#include "trainer/splats/tile_raster.hpp"

namespace tureen::trainer {

struct SplatStepReport {
  double loss = 0, l1 = 0, ssim = 0;  // of the image
  std::size_t quarantined = 0;        // splats and pixels that are not finite
  std::size_t dead = 0, split = 0;    // of a densification after this step
};

/// Mean squared error of a step's image over the pixels of the view that are not ignored, without
/// clamping. `planes`: red, green and blue.
double mean_squared_error(std::span<const float> planes, const TrainingView& view);

/// `Training`: as GaussianTraining and WindowTraining; NeuralTraining has rate_factor(), too.
template <class Training>
class SplatTrainer {
 public:
  using Config = typename Training::Config;
  using Parameters = typename Training::Parameters;
  using State = SplatState<Parameters>;

  /// Begins with random splats. `views` must outlive the trainer. `threads`: 0 for all cores.
  SplatTrainer(const Config& config, std::span<const TrainingView> views, const Region& region,
               int threads)
      : SplatTrainer(config, views, region, threads, {.random = Random(config.seed)}) {
    begin();
  }

  /// Continues from a state, whose splats have config.degree.
  SplatTrainer(const Config& config, std::span<const TrainingView> views, const Region& region,
               int threads, State state)
      : config_(config),
        views_(views),
        region_(region),
        pool_(threads),
        raster_(pool_),
        state_(std::move(state)) {
    assert(!views.empty() && config.degree <= max_trained_degree);
    state_.non_finite = 0;
  }

  bool done() const { return state_.step >= config_.steps; }
  int steps_done() const { return state_.step; }
  /// Sets the number of steps of the run, at least steps_done(), for the schedule from the next
  /// step on.
  void set_steps(int steps) { config_.steps = steps; }
  const Config& config() const { return config_; }
  const Parameters& parameters() const { return state_.parameters; }
  /// For a checkpoint, which has its own SplatState::non_finite.
  const State& state() const { return state_; }
  int threads() const { return pool_.threads(); }
  SplatTimes& times() { return raster_.times(); }

  SplatStepReport step() {
    assert(!done());
    const TrainingView& view = next_view();
    last_view_ = &view;
    const int width = view.camera.width, height = view.camera.height;
    planes_.resize(3 * std::size_t(width) * std::size_t(height));
    gradient_.resize(planes_.size());
    VarianceLoss variance{.ignored = view.ignored};
    if constexpr (TileRaster<Training>::has_variance)
      variance.weight = Training::variance_weight(config_, parameters());
    raster_.forward(state_.parameters, camera_of_step(view), degree_now(), background(), planes_,
                    variance.weight > 0);
    SplatStepReport report;
    {
      const Stopwatch watch(times().loss);
      const ImageLoss loss = image_loss<float>({.width = width,
                                                .height = height,
                                                .rendered = planes_,
                                                .target = view.target,
                                                .ignored = view.ignored,
                                                .l1_weight = config_.l1_weight,
                                                .ssim_weight = config_.ssim_weight,
                                                .gradient = gradient_},
                                               loss_scratch_, pool_);
      report = {
          .loss = loss.loss, .l1 = loss.l1, .ssim = loss.ssim, .quarantined = loss.non_finite};
    }
    const auto input = raster_.backward(planes_, gradient_, variance);
    const Stopwatch watch(times().update);
    report.quarantined += update(input);
    ++times().steps;
    ++state_.step;
    if (densifies_after(config_, state_.step)) {
      const DensifyReport densified =
          Training::densify(config_, state_.step, state_.step / densify_interval(config_),
                            state_.random, state_.parameters, state_.memory);
      // No splat is left to split: the run begins again, at other places.
      if (densified.dead == parameters().count()) begin();
      sort_in_memory(region_, state_.parameters, state_.memory);
      report.dead = densified.dead;
      report.split = densified.split;
    }
    Training::limit(config_, state_.step, state_.parameters);
    return report;
  }

  /// The splats so far as a scene stores them.
  Primitives primitives() const {
    std::span<const float> evident;
    if (knows_evident())
      evident = {state_.memory.statistics.row(splat_statistic::evident), parameters().count()};
    return Training::primitives(config_, parameters(), evident);
  }

  /// mean_squared_error() of the last step. Needs a step().
  double last_mse() const { return mean_squared_error(planes_, *last_view_); }

  /// Red, green and blue planes, row 0 on top, not clamped; with harmonics of all degrees.
  std::vector<float> render(const Camera& camera) {
    const SplatTimes times = raster_.times();
    std::vector<float> planes(3 * std::size_t(camera.width) * std::size_t(camera.height));
    raster_.forward(state_.parameters, camera, config_.degree, background(), planes);
    raster_.times() = times;
    return planes;
  }

 private:
  std::span<const float, 3> background() const {
    return std::span<const float, 3>(config_.background);
  }

  int degree_now() const {
    const int reached = int(state_.step / std::max(1.0, config_.degree_steps * config_.steps));
    return std::min(config_.degree, reached);
  }

  /// Whether each view was used since the last densification: 2 n - 1 steps contain a whole epoch
  /// of n views. Exact if a densification followed the last set_steps().
  bool knows_evident() const {
    const int every = densify_interval(config_);
    int last = state_.step / every * every;
    while (last > 0 && !densifies_after(config_, last)) last -= every;
    return state_.step - last >= 2 * int(views_.size()) - 1;
  }

  void begin() {
    state_.parameters = random_splats<Training>(config_, region_, state_.random);
    state_.memory = SplatMemory(parameters().rows(), parameters().count());
  }

  const TrainingView& next_view() {
    std::vector<std::uint32_t>& epoch = state_.epoch;
    if (epoch.empty()) epoch = draw(state_.random, views_.size(), views_.size());
    const bool half = state_.step < config_.half_size_until * config_.steps;
    if (half && half_views_.empty())
      for (const TrainingView& each : views_)
        half_views_.push_back(each.stored ? each : halved(each));
    if (!half) half_views_ = {};
    const TrainingView& view = half ? half_views_[epoch.back()] : views_[epoch.back()];
    epoch.pop_back();
    if (!view.stored) return view;
    read_view_ = loaded(view);
    if (half) read_view_ = halved(read_view_);
    if (!epoch.empty()) expect(views_[epoch.back()]);
    return read_view_;
  }

  /// With Config::jitter, the rays of the step pass through a random point of each pixel, the same
  /// in all.
  Camera camera_of_step(const TrainingView& view) {
    Camera camera = view.camera;
    if constexpr (requires { config_.jitter; }) {
      if (config_.jitter > 0) {
        camera.cx += config_.jitter * state_.random.uniform(-0.5, 0.5);
        camera.cy += config_.jitter * state_.random.uniform(-0.5, 0.5);
      }
    }
    return camera;
  }

  /// Returns the number of splats that are not finite.
  std::size_t update(const BackwardInput<typename Training::Moments>& input) {
    const double done = double(state_.step) / config_.steps;
    const std::size_t count = parameters().count();
    typename Training::Step step = Training::step_of(config_, region_.half_side, done, count);
    for (std::size_t k = 0; k < Training::kinds.size(); ++k) {
      const ParameterKind& kind = Training::kinds[k];
      step.rates[k] = float(kind.rate * std::pow(double(kind.last_rate) / kind.rate, done));
      if constexpr (requires { Training::rate_factor(config_, k, count); })
        step.rates[k] *= Training::rate_factor(config_, k, count);
    }
    step.rates[0] *= float(region_.half_side) * Training::position_rate(parameters());
    std::atomic<std::size_t> quarantined = 0;
    run_in_tasks(pool_, count, [&](std::size_t begin, std::size_t end) {
      quarantined += Training::step_functions().step(input, step, begin, end, state_.parameters,
                                                     state_.memory);
    });
    return quarantined;
  }

  Config config_;
  std::span<const TrainingView> views_;
  std::vector<TrainingView> half_views_;
  TrainingView read_view_ = {
      .camera = {}, .target = {}, .ignored = {}};  // of this step, if it is stored
  Region region_;                                  // its half side is the unit of rates and scales
  ThreadPool pool_;
  TileRaster<Training> raster_;
  State state_;
  const TrainingView* last_view_ = nullptr;
  std::vector<float> planes_, gradient_;
  ImageLossScratch<float> loss_scratch_;
};

}  // namespace tureen::trainer
