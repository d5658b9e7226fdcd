#include "trainer/splats/gaussian_training.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussian_forecast.hpp"
#include "trainer/splats/gaussian_initialise.hpp"
#include "trainer/splats/gaussian_trainer.hpp"

namespace tureen::trainer {

namespace {

/// Fractions of the run at which the number of steps is fitted to the time. Several, because the
/// number of splats and their sizes change; none late, because a change of the number disturbs the
/// decay of the rates.
constexpr std::array<double, 3> fit_at{0.1, 0.3, 0.5};

/// Time of a run, with log, held-out views and previews, over that of its steps. An estimate.
constexpr double overhead = 1.03;

/// The camera in coordinates relative to `origin`, where floats are exact enough.
Camera moved(Camera camera, glm::dvec3 origin) {
  camera.view_from_world = camera.view_from_world * at_origin(origin);
  return camera;
}

/// The splats that a viewer can draw.
Splats drawable(const Splats& all) {
  const auto& gaussians = std::get<Gaussians>(all.kernel);
  const std::size_t coefficients = coefficients_per_splat(all.color);
  Splats kept{.kernel = Gaussians{}, .color = {.degree = all.color.degree}, .profile = all.profile};
  auto& into = std::get<Gaussians>(kept.kernel);
  for (std::size_t i = 0; i < gaussians.centers.size(); ++i) {
    const glm::vec3* color = all.color.coefficients.data() + i * coefficients;
    const glm::quat q = gaussians.rotations[i];
    float sum = gaussians.opacity[i] + q.x + q.y + q.z + q.w;  // finite if all values are
    for (int axis = 0; axis < 3; ++axis) {
      sum += gaussians.centers[i][axis] + gaussians.scales[i][axis];
      for (std::size_t k = 0; k < coefficients; ++k) sum += color[k][axis];
    }
    if (!std::isfinite(sum) || gaussians.opacity[i] < all.profile.min_alpha) continue;
    into.centers.push_back(gaussians.centers[i]);
    into.scales.push_back(gaussians.scales[i]);
    into.rotations.push_back(q);
    into.opacity.push_back(gaussians.opacity[i]);
    kept.color.coefficients.insert(kept.color.coefficients.end(), color, color + coefficients);
  }
  return kept;
}

class GaussianRun final : public Trainable {
 public:
  /// `run`: configuration and views for the checkpoints, and the seconds so far.
  GaussianRun(GaussianTrainer& trainer, glm::dvec3 origin, GaussianCheckpoint run)
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
    return trainer_.render(moved(camera, origin_));
  }
  std::span<const float, 3> background() const override {
    return std::span<const float, 3>(trainer_.config().background);
  }

  StepReport step() override {
    fit();
    double seconds = 0;
    GaussianStepReport report;
    const double work = remaining_work(trainer_.config(), steps_done());
    {
      const Stopwatch watch(seconds);
      report = trainer_.step();
    }
    spent_ += overhead * seconds;
    recent_ += overhead * seconds;
    recent_work_ += work - remaining_work(trainer_.config(), steps_done());
    non_finite_ += report.quarantined;
    return {.loss = report.loss,
            .l1 = report.l1,
            .ssim = report.ssim,
            .mse = trainer_.last_mse(),
            .non_finite = report.quarantined};
  }

  void write_checkpoint(const std::filesystem::path& path, double seconds) const override {
    GaussianCheckpoint run = run_;
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
    trainer_.set_steps(fitted_steps(trainer_.config(), steps_done(),
                                    60 * run_.config.minutes - spent_, recent_ / recent_work_));
    ++fits_;
    recent_ = recent_work_ = 0;
  }

  GaussianTrainer& trainer_;
  glm::dvec3 origin_;
  GaussianCheckpoint run_;  // without a state
  double spent_ = 0;        // seconds, over all sessions
  double recent_ = 0;       // seconds of the steps since the last fit
  double recent_work_ = 0;  // their work, in steps of full size
  std::uint64_t non_finite_ = 0;
  int fits_ = 0;
};

GaussianState first_state(const Dataset& dataset, const GaussianConfig& config,
                          const Region& region, const Scene* start) {
  GaussianState state{.random = Random(config.seed)};
  state.parameters = initial_gaussians(dataset, config, region, start, state.random);
  state.memory = SplatMemory(state.parameters.rows(), state.parameters.count());
  return state;
}

}  // namespace

GaussianResult train_gaussians(Dataset& dataset, GaussianRequest request) {
  GaussianCheckpoint run{.config = request.config,
                         .views = fingerprint(dataset.train),
                         .seconds = request.checkpoint ? request.checkpoint->seconds : 0.0,
                         .state = {}};
  assert(!request.checkpoint || !difference(run.views, request.checkpoint->views));
  const Region region = region_of_interest(dataset);
  run.state = request.checkpoint ? std::move(request.checkpoint->state)
                                 : first_state(dataset, run.config, region, request.start);
  GaussianForecast forecast{.splats = run.state.parameters.count(),
                            .bytes = gaussian_memory(run.config, dataset)};

  std::vector<TrainingView> views =
      take_training_views(dataset.train, std::span<const float, 3>(run.config.background));
  for (TrainingView& view : views) view.camera = moved(view.camera, region.centre);
  const Region local{.centre = glm::dvec3(0), .half_side = region.half_side};
  const double step_seconds =
      measured_step_seconds(run.config, views, local, request.run.threads, run.state);
  if (request.checkpoint && run.config.minutes > 0)
    run.config.steps = request.checkpoint->config.steps;
  else if (run.config.minutes > 0)
    run.config.steps =
        fitted_steps(run.config, 0, 60 * run.config.minutes, overhead * step_seconds);
  GaussianTrainer trainer(run.config, views, local, request.run.threads, run.state);
  forecast.steps = run.config.steps;
  forecast.seconds = overhead * step_seconds * remaining_work(run.config, run.state.step);
  forecast.threads = trainer.threads();
  if (request.begun) request.begun(forecast);

  request.run.session.seconds_before = run.seconds;
  request.run.session.non_finite_before = run.state.non_finite;
  GaussianRun gaussian_run(trainer, region.centre, std::move(run));
  const auto scene = [&] {
    return tureen::scene_of(drawable(trainer.parameters().splats()), region.centre);
  };
  GaussianResult result;
  result.run = run_to_the_end(gaussian_run, std::move(request.run), dataset, scene);
  result.steps = trainer.steps_done();
  result.splats = splat_count(scene());
  result.non_finite = gaussian_run.non_finite();
  return result;
}

}  // namespace tureen::trainer
