#include "trainer/splats/splat_training.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/neural/neural_training.hpp"
#include "trainer/splats/splat_forecast.hpp"
#include "trainer/splats/windows/window_training.hpp"

namespace tureen::trainer {

namespace {

/// Fractions of the run at which the number of steps is fitted to the time again. Several, because
/// the number of splats and their sizes change; none late, because a change of the number disturbs
/// the decay of the rates.
constexpr std::array<double, 3> fit_at{0.1, 0.3, 0.5};

/// The first fit, which counts as none in SplatState::fits: after 20 steps, which the caches and
/// the processor's clock need, but not after more than a twentieth of the time.
constexpr int first_fit_steps = 20;
constexpr double first_fit_share = 0.05;

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
  /// Until the last fit, steps() is a guess, but the time is known.
  std::optional<double> seconds_left() const override {
    if (!fits_again()) return std::nullopt;
    return std::max(0.0, run_seconds() - spent_);
  }
  double work_of_step() const override {
    const double work = remaining_work(trainer_.config(), steps_done());
    return double(trainer_.parameters().count()) *
           (work - remaining_work(trainer_.config(), steps_done() + 1));
  }
  double work_left() const override {
    const std::size_t splats = trainer_.parameters().count();
    return double(splats) * growth_of_work(trainer_.config(), steps_done(), splats) *
           remaining_work(trainer_.config(), steps_done());
  }
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
    const double work = work_of_step();
    {
      const Stopwatch watch(seconds);
      report = trainer_.step();
    }
    spent_ += overhead * seconds;
    if (std::exchange(has_stepped_, true)) {  // the first step allocates
      recent_ += overhead * seconds;
      recent_work_ += work;
    }
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
  double run_seconds() const { return 60 * run_.config.minutes; }
  bool fits_again() const { return run_seconds() > 0 && fits_ < int(fit_at.size()); }
  bool fit_is_due() const {
    if (!fits_again() || recent_work_ == 0) return false;
    if (fits_ < 0)
      return steps_done() >= first_fit_steps || spent_ >= first_fit_share * run_seconds();
    return steps_done() >= fit_at[std::size_t(fits_)] * steps();
  }

  /// Fits the number of steps to the time that is left.
  void fit() {
    if (!fit_is_due()) return;
    const std::size_t splats = trainer_.parameters().count();
    const double step_seconds = recent_ / recent_work_ * double(splats) *
                                growth_of_work(trainer_.config(), steps_done(), splats);
    trainer_.set_steps(
        fitted_steps(trainer_.config(), steps_done(), run_seconds() - spent_, step_seconds));
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
  int fits_ = 0;  // SplatState::fits
  bool has_stepped_ = false;
};

template <class Training, class Request>
SplatResult train_by(Dataset& dataset, Request request) {
  typename SplatRun<Training>::Checkpoint run{
      .config = request.config,
      .views = fingerprint(dataset.train),
      .seconds = request.checkpoint ? request.checkpoint->seconds : 0.0,
      .state = {}};
  assert(!request.checkpoint || !difference(run.views, request.checkpoint->views));
  const Region region = region_of_interest(dataset);
  std::optional<Scene> first;
  if (!request.checkpoint && !request.start && request.first_scene) {
    const Stopwatch watch(run.seconds);
    first = request.first_scene(region);
  }
  run.state = request.checkpoint ? std::move(request.checkpoint->state)
                                 : first_splats<Training>(dataset, run.config, region,
                                                          first ? &*first : request.start);
  const std::size_t splats = run.state.parameters.count();
  std::vector<TrainingView> views =
      take_training_views(dataset.train, std::span<const float, 3>(run.config.background));
  for (TrainingView& view : views) view.camera = relative_to(view.camera, region.center);
  const Region local{.center = glm::dvec3(0), .half_side = region.half_side};
  if (run.config.minutes > 0) {
    run.config.steps =
        request.checkpoint ? request.checkpoint->config.steps : typename Training::Config{}.steps;
    if (!request.checkpoint) run.state.fits = -1;
  }
  SplatTrainer<Training> trainer(run.config, views, local, request.run.threads, run.state);
  if (request.begun) request.begun({.splats = splats, .threads = trainer.threads()});

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
template SplatResult train_splats(Dataset&, NeuralRequest);
template SplatResult train_splats(Dataset&, WindowRequest);

}  // namespace tureen::trainer
