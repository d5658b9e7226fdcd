#include "trainer/diffsoup/training.hpp"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "scene/edit/lattice_bytes.hpp"
#include "trainer/common/stopwatch.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/initialise.hpp"
#include "trainer/diffsoup/near_zone.hpp"
#include "trainer/diffsoup/texture_level.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::trainer {

namespace {

TrainingState first_state(const Dataset& dataset, const Config& config, const Scene* start) {
  TrainingState state;
  state.model = initial_model(dataset, config, start);
  state.moments.reset_faces(state.model);
  return state;
}

double opacity_binary_fraction(const Model& model) {
  std::uint64_t binary = 0, texels = 0;
  std::vector<float> values;
  for (std::size_t face = 0; face < model.faces(); ++face) {
    fine_texture(model, face, values);
    for (std::size_t i = alpha_channel; i < values.size(); i += channels) {
      binary += values[i] <= 0.05f || values[i] >= 0.95f;
      ++texels;
    }
  }
  return texels > 0 ? double(binary) / double(texels) : 1.0;
}

Scene scene_of(const TrainingState& state) {
  Scene scene = to_scene(state.model);
  round_to_bytes(std::get<LatticeTexture>(only_soup(scene).appearance));
  return scene;
}

/// A Trainer for a session. `run`: configuration and views for the checkpoints.
class SoupRun final : public Trainable {
 public:
  SoupRun(Trainer& trainer, Checkpoint run) : trainer_(trainer), run_(std::move(run)) {
    run_.state = {};
  }

  int steps() const override { return trainer_.config().steps; }
  int steps_done() const override { return trainer_.steps_done(); }
  void set_steps(int steps) override { trainer_.set_steps(steps); }
  StepReport step() override { return trainer_.step(); }
  PrimitiveCount primitives() const override {
    return {PrimitiveKind::triangles, trainer_.faces()};
  }
  std::vector<float> render(const Camera& camera) override {
    return trainer_.backend().render(camera);
  }
  std::span<const float, 3> background() const override {
    return std::span<const float, 3>(trainer_.config().background);
  }
  void write_checkpoint(const std::filesystem::path& path, double seconds) const override {
    Checkpoint run = run_;
    run.config.steps = steps();
    run.seconds = seconds;
    run.state = trainer_.state();
    trainer::write_checkpoint(path, run);
  }

 private:
  Trainer& trainer_;
  Checkpoint run_;  // without a state
};

/// Whether any view shows a face from `first` on.
bool shows_something(Backend& backend, std::span<const TrainingView> views, std::size_t first) {
  return std::any_of(views.begin(), views.end(), [&](const TrainingView& view) {
    const std::vector<std::uint64_t> pixels = backend.visible_pixels({&view.camera, 1});
    return std::ranges::any_of(std::span(pixels).subspan(std::min(first, pixels.size())),
                               [](auto count) { return count > 0; });
  });
}

}  // namespace

Config settled(const Config& config, const Dataset& dataset, const Region& region) {
  Config result = scaled_to(with_fitting_level(config, dataset), region.half_side);
  result = with_empty_near_zone(result, dataset, region);
  return with_visible_backing(result, dataset, region);
}

TrainingResult train(Dataset& dataset, TrainingRequest request) {
  Config config = request.config;
  if (config.minutes > 0 && request.checkpoint) config.steps = request.checkpoint->config.steps;
  assert(request.checkpoint ||
         (request.start != nullptr) == (config.initialisation == Initialisation::mesh));
  Checkpoint run{.config = config,
                 .views = fingerprint(dataset.train),
                 .seconds = request.checkpoint ? request.checkpoint->seconds : 0.0,
                 .state = {}};
  assert(!request.checkpoint || !difference(run.views, request.checkpoint->views));
  const Region region = region_of_interest(dataset);
  const Config constants = settled(config, dataset, region);
  std::optional<Scene> first;
  if (!request.checkpoint && request.first_scene &&
      constants.initialisation == Initialisation::automatic) {
    const Stopwatch watch(run.seconds);
    first = request.first_scene(constants, region);
  }
  run.state = request.checkpoint ? std::move(request.checkpoint->state)
                                 : first_state(dataset, constants, first ? &*first : request.start);
  const std::vector<TrainingView> views = take_training_views(dataset.train, constants.background);
  Trainer trainer(constants, views,
                  make_backend(views, constants, request.device, request.run.threads), run.state);
  TrainingResult result;
  result.visible_at_start = shows_something(trainer.backend(), views, backing_faces(config));
  if (request.begun)
    request.begun({.settled = constants,
                   .backend = trainer.backend(),
                   .triangles = trainer.faces(),
                   .is_visible = result.visible_at_start});

  request.run.session.seconds_before = run.seconds;
  request.run.session.seconds = 60 * config.minutes;
  request.run.session.non_finite_before = run.state.non_finite;
  SoupRun soup_run(trainer, std::move(run));
  result.run = run_to_the_end(soup_run, std::move(request.run), dataset,
                              [&] { return scene_of(trainer.state()); });
  result.state = trainer.state();
  result.opacity_binary_fraction = opacity_binary_fraction(result.state.model);
  return result;
}

}  // namespace tureen::trainer
