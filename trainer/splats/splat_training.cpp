#include "trainer/splats/splat_training.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_forecast.hpp"
#include "trainer/splats/windows/window_training.hpp"

namespace tureen::trainer {

namespace {

/// Fractions of the run at which the number of steps is fitted to the time. Several, because the
/// number of splats and their sizes change; none late, because a change of the number disturbs the
/// decay of the rates.
constexpr std::array<double, 3> fit_at{0.1, 0.3, 0.5};

/// Time of a run, with log, held-out views and previews, over that of its steps. An estimate.
constexpr double overhead = 1.03;

PrimitiveCount count_of(const Primitives& primitives) {
  if (const auto* splats = std::get_if<Splats>(&primitives))
    return {PrimitiveKind::splats, count(*splats)};
  return {PrimitiveKind::triangles, std::get<TriangleSoup>(primitives).triangles.size()};
}

template <class Training>
class SplatRun final : public Trainable {
 public:
  using Checkpoint = SplatCheckpoint<typename Training::Config, typename Training::Parameters>;

  /// `run`: configuration and views for the checkpoints, and the seconds so far.
  SplatRun(SplatTrainer<Training>& trainer, glm::dvec3 origin, Checkpoint run)
      : trainer_(trainer), origin_(origin), run_(std::move(run)) {
    spent_ = run_.seconds;
    non_finite_ = run_.state.non_finite;
    fits_ = run_.state.fits;
    run_.state = {};
  }

  int steps() const override { return trainer_.config().steps; }
  int steps_done() const override { return trainer_.steps_done(); }
  PrimitiveCount primitives() const override {
    return {PrimitiveKind::splats, trainer_.parameters().count()};
  }
  std::vector<float> render(const Camera& camera) override {
    return trainer_.render(relative_to(camera, origin_));
  }
  std::span<const float, 3> background() const override {
    return std::span<const float, 3>(trainer_.config().background);
  }

  StepReport step() override {
    fit();
    double seconds = 0;
    SplatStepReport report;
    const double work = remaining_work(trainer_.config(), steps_done());
    const auto splats = double(trainer_.parameters().count());
    {
      const Stopwatch watch(seconds);
      report = trainer_.step();
    }
    spent_ += overhead * seconds;
    recent_ += overhead * seconds;
    recent_work_ += splats * (work - remaining_work(trainer_.config(), steps_done()));
    non_finite_ += report.quarantined;
    return {.loss = report.loss,
            .l1 = report.l1,
            .ssim = report.ssim,
            .mse = trainer_.last_mse(),
            .non_finite = report.quarantined};
  }

  void write_checkpoint(const std::filesystem::path& path, double seconds) const override {
    Checkpoint run = run_;
    run.config.steps = steps();
    run.seconds = seconds;
    run.state = trainer_.state();
    run.state.non_finite = non_finite_;
    run.state.fits = fits_;
    trainer::write_checkpoint(path, run);
  }

  std::uint64_t non_finite() const { return non_finite_; }

 private:
  /// Fits the number of steps to the time that is left, at the fractions of fit_at.
  void fit() {
    if (!(run_.config.minutes > 0) || fits_ >= int(fit_at.size()) || recent_work_ == 0) return;
    if (steps_done() < fit_at[std::size_t(fits_)] * steps()) return;
    const std::size_t splats = trainer_.parameters().count();
    const double step_seconds = recent_ / recent_work_ * double(splats) *
                                growth_of_work(trainer_.config(), steps_done(), splats);
    trainer_.set_steps(fitted_steps(trainer_.config(), steps_done(),
                                    60 * run_.config.minutes - spent_, step_seconds));
    ++fits_;
    recent_ = recent_work_ = 0;
  }

  SplatTrainer<Training>& trainer_;
  glm::dvec3 origin_;
  Checkpoint run_;          // without a state
  double spent_ = 0;        // seconds, over all sessions
  double recent_ = 0;       // seconds of the steps since the last fit
  double recent_work_ = 0;  // their work, in steps of full size with one splat
  std::uint64_t non_finite_ = 0;
  int fits_ = 0;
};

/// Seconds of a step of full size from this state: the mean over a few steps of a copy. Takes about
/// half a second, or two steps if they take longer. `threads`: 0 for all cores.
template <class Training>
double measured_step_seconds(typename Training::Config probe, std::span<const TrainingView> views,
                             const Region& region, int threads,
                             const SplatState<typename Training::Parameters>& state) {
  constexpr int max_steps = 20;
  constexpr double enough = 0.5;  // seconds
  probe.steps = state.step + max_steps + 1;
  probe.densify_until = 0;
  probe.half_size_until = 0;
  // The schedule of the probe would make the windows opaque.
  if constexpr (requires { probe.opaque; }) probe.opaque = false;
  SplatTrainer<Training> trainer(probe, views, region, threads, state);
  trainer.step();  // allocates
  double seconds = 0;
  int steps = 0;
  for (; steps < max_steps && seconds < enough; ++steps) {
    const Stopwatch watch(seconds);
    trainer.step();
  }
  return seconds / steps;
}

template <class Training, class Request>
SplatResult train_by(Dataset& dataset, Request request) {
  typename SplatRun<Training>::Checkpoint run{
      .config = request.config,
      .views = fingerprint(dataset.train),
      .seconds = request.checkpoint ? request.checkpoint->seconds : 0.0,
      .state = {}};
  assert(!request.checkpoint || !difference(run.views, request.checkpoint->views));
  const Region region = region_of_interest(dataset);
  run.state = request.checkpoint
                  ? std::move(request.checkpoint->state)
                  : first_splats<Training>(dataset, run.config, region, request.start);
  SplatForecast forecast{.splats = run.state.parameters.count(),
                         .bytes = splat_memory(run.config, dataset)};

  std::vector<TrainingView> views =
      take_training_views(dataset.train, std::span<const float, 3>(run.config.background));
  for (TrainingView& view : views) view.camera = relative_to(view.camera, region.center);
  const Region local{.center = glm::dvec3(0), .half_side = region.half_side};
  if (request.checkpoint && run.config.minutes > 0)
    run.config.steps = request.checkpoint->config.steps;
  const double step_seconds =
      overhead *
      measured_step_seconds<Training>(run.config, views, local, request.run.threads, run.state) *
      growth_of_work(run.config, run.state.step, run.state.parameters.count());
  if (!request.checkpoint && run.config.minutes > 0)
    run.config.steps = fitted_steps(run.config, 0, 60 * run.config.minutes, step_seconds);
  SplatTrainer<Training> trainer(run.config, views, local, request.run.threads, run.state);
  forecast.steps = run.config.steps;
  forecast.seconds = step_seconds * remaining_work(run.config, run.state.step);
  forecast.threads = trainer.threads();
  if (request.begun) request.begun(forecast);

  request.run.session.seconds_before = run.seconds;
  request.run.session.non_finite_before = run.state.non_finite;
  SplatRun<Training> splat_run(trainer, region.center, std::move(run));
  SplatResult result;
  result.run = run_to_the_end(splat_run, std::move(request.run), dataset,
                              [&] { return scene_of(trainer.primitives(), region.center); });
  result.steps = trainer.steps_done();
  result.primitives = count_of(trainer.primitives());
  result.non_finite = splat_run.non_finite();
  return result;
}

}  // namespace

template <class Config, class Parameters>
SplatResult train_splats(Dataset& dataset, SplatRequest<Config, Parameters> request) {
  return with_training(request.config, [&]<class Training>() {
    return train_by<Training>(dataset, std::move(request));
  });
}

template SplatResult train_splats(Dataset&, GaussianRequest);
template SplatResult train_splats(Dataset&, WindowRequest);

}  // namespace tureen::trainer
