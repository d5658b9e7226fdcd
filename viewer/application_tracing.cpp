// The ray-traced image of the still view, drawn in the background.
#include <limits>

#include "runtime/passes/accumulation.hpp"
#include "tracing/progressive_image.hpp"
#include "viewer/application.hpp"

namespace tureen::viewer {

namespace {

/// After this time, an image that is sharp gets no further sample: on slow scenes, the cores of an
/// idle window would be busy for many minutes.
constexpr double max_seconds = 60;
/// Between two images on the screen: each costs some frames of the interface.
constexpr double seconds_between = 0.25;

}  // namespace

/// Used by one job at a time; they run in one thread.
struct Application::Rays {
  explicit Rays(const glm::vec3& background)
      : background(background), images({.background = background}) {}

  glm::vec3 background;
  std::map<LayerId, ProfiledSplats> profiled;
  tracing::TracedImages images;
  double seconds_per_pixel = 0;  // measured
};

bool Application::traces() const {
  // Its image is opaque: it would hide the checkerboard.
  return state_.trace && state_.stage && !state_.stage->debug_views && !state_.shows_checks &&
         stands_still();
}

/// Those of the image at rest, where the scene has one.
int Application::traced_samples() const {
  if (state_.settings.smooth_at_rest && state_.stage->renderer.has_image_at_rest())
    return samples_at_rest * samples_at_rest;
  const int side = state_.source.document.quality.supersampling;
  return side * side;
}

void Application::forget_traced() {
  if (state_.trace && !traced_image_) return;
  tracer_.abandon(JobKind::tracing);
  traced_image_.reset();
  state_.traced = {};
  if (!state_.trace) rays_.reset();
}

void Application::trace(const Camera& camera) {
  TracedView& view = state_.traced;
  if (!traces()) return forget_traced();
  if (!worker_.idle() || !writer_.idle()) {  // as in refines(); goes on later
    tracer_.abandon(JobKind::tracing);
    view.is_running = false;
    return;
  }
  if (view.is_running || view.is_complete) return;
  if (!traced_image_) {
    view.wanted = traced_samples();
    traced_image_ = std::make_shared<tracing::ProgressiveImage>(camera, view.wanted, max_seconds);
  }
  const glm::vec3 background = background_of(state_.source);
  if (!rays_ || rays_->background != background) rays_ = std::make_shared<Rays>(background);
  view.is_running = true;
  const auto work = [this, rays = rays_, image = traced_image_,
                     source = state_.drawn_source()](const Worker::Progress& progress) {
    rays->images.report_to([&](double) { progress(0); });
    rays->images.sync(layers_for_rays(source, rays->profiled));
    double shown = -std::numeric_limits<double>::infinity();
    do {
      image->step(rays->images, rays->seconds_per_pixel);
      const double now = steady_seconds();
      if (now - shown < seconds_between && !image->is_complete()) continue;
      shown = now;
      tracer_.post([this, pixels = std::make_shared<Image8>(image->image()), sharp = image->sharp(),
                    samples = image->samples()] {
        state_.traced.texture = ImageTexture(*pixels);
        state_.traced.sharp = sharp;
        state_.traced.samples = samples;
      });
    } while (!image->is_complete());
    return Worker::Completion([this] {
      state_.traced.is_running = false;
      state_.traced.is_complete = true;
    });
  };
  const auto failed = [this](const std::string& reason) {
    state_.trace = false;
    forget_traced();
    state_.error("The view cannot be ray-traced", reason);
  };
  tracer_.start({.kind = JobKind::tracing, .what = "ray tracing", .work = work, .failed = failed});
}

}  // namespace tureen::viewer
