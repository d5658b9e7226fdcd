#include "trainer/splats/splat_training.hpp"

#include <cassert>
#include <utility>

#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/neural/neural_training.hpp"
#include "trainer/splats/splat_forecast.hpp"
#include "trainer/splats/windows/window_training.hpp"

namespace tureen::trainer {

namespace {

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
    non_finite_ = run_.state.non_finite;
    run_.state = {};
  }

  int steps() const override { return trainer_.config().steps; }
  int steps_done() const override { return trainer_.steps_done(); }
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
  int steps_in(double seconds, double seconds_per_work) const override {
    const std::size_t splats = trainer_.parameters().count();
    return fitted_steps(trainer_.config(), steps_done(), seconds,
                        seconds_per_work * double(splats) *
                            growth_of_work(trainer_.config(), steps_done(), splats));
  }
  void set_steps(int steps) override { trainer_.set_steps(steps); }
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
    const SplatStepReport report = trainer_.step();
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
    trainer::write_checkpoint(path, run);
  }

  std::uint64_t non_finite() const { return non_finite_; }

 private:
  SplatTrainer<Training>& trainer_;
  glm::dvec3 origin_;
  Checkpoint run_;  // without a state
  std::uint64_t non_finite_ = 0;
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
  if (request.checkpoint) {
    run.state = std::move(request.checkpoint->state);
  } else {
    const Stopwatch watch(run.seconds);
    run.state =
        first_splats<Training>(dataset, run.config, region, first ? &*first : request.start,
                               {.threads = request.run.threads, .progress = request.run.preparing});
  }
  const std::size_t splats = run.state.parameters.count();
  std::vector<TrainingView> views =
      take_training_views(dataset.train, std::span<const float, 3>(run.config.background));
  for (TrainingView& view : views) view.camera = relative_to(view.camera, region.center);
  const Region local{.center = glm::dvec3(0), .half_side = region.half_side};
  if (run.config.minutes > 0)
    run.config.steps =
        request.checkpoint ? request.checkpoint->config.steps : typename Training::Config{}.steps;
  SplatTrainer<Training> trainer(run.config, views, local, request.run.threads, run.state);
  if (request.begun) request.begun({.splats = splats, .threads = trainer.threads()});

  request.run.session.seconds_before = run.seconds;
  request.run.session.seconds = 60 * run.config.minutes;
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
