#include "viewer/stage.hpp"

#include <chrono>
#include <utility>

#include "formats/scene_file.hpp"

namespace tureen::viewer {

namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Fraction of the progress bar for reading; the rest is for preparation.
constexpr double reading_share = 0.9;

}  // namespace

Quality quality_of(const DrawingChoice& choice, const Scene& scene) {
  return choice.quality.value_or(scene.quality);
}

RenderOptions render_options(const DrawingChoice& choice, const Scene& scene) {
  RenderOptions options;
  options.plan = choice.plan;
  options.background = glm::vec4(scene.info.background, 1.0f);
  options.plan.quality = quality_of(choice, scene);
  return options;
}

Renderer prepare_renderer(const StageSource& source, const StageRequest& request) {
  const Scene& scene = *source.scene;
  return make_renderer(request.context, scene, request.choice.pipeline,
                       render_options(request.choice, scene));
}

std::unique_ptr<Stage> read_stage(const std::filesystem::path& path, const StageRequest& request) {
  const Stopwatch reading;
  const FileWatch watch(path);
  auto scene = std::make_shared<Scene>(
      read_scene(path, {.progress = [&](double done) { request.progress(reading_share * done); }}));
  make_opaque(*scene);
  StageSource source;
  source.path = path;
  source.watch = watch;
  source.scene = scene;
  source.subject = subject_of(*scene);
  source.up = guess_up(evidence_of(*scene, source.subject));
  source.subject.up = source.up.axis;
  source.read_seconds = reading.seconds();
  const auto preparing = [&](double done) {
    request.progress(reading_share + (1 - reading_share) * done);
  };
  return prepare_stage(source, {request.context, request.choice, preparing});
}

std::unique_ptr<Stage> prepare_stage(const StageSource& source, const StageRequest& request) {
  const Stopwatch preparing;
  Renderer renderer = prepare_renderer(source, request);
  renderer.leave_context();
  return std::make_unique<Stage>(
      Stage{{source}, request.choice, std::nullopt, std::move(renderer), preparing.seconds()});
}

std::unique_ptr<Stage> prepare_debug_stage(const StageSource& source, const StageRequest& request) {
  const Stopwatch preparing;
  const Scene& scene = *source.scene;
  const RenderOptions options{.background = glm::vec4(scene.info.background, 1.0f)};
  const DeviceLimits limits = device_limits(request.context.capabilities());
  const std::vector<PlacedSoup> layers = placed_soups(scene);
  Renderer renderer(request.context, prepare_debug_views(layers, limits, options), options);
  renderer.leave_context();
  return std::make_unique<Stage>(Stage{
      {source}, request.choice, DebugViews(layers), std::move(renderer), preparing.seconds()});
}

}  // namespace tureen::viewer
