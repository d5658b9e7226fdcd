// Debug views and the comparison with a photograph. Both are prepared on first use.
#include "base/error.hpp"
#include "image/heat_map.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

void Application::prepare_debug_view_when_needed() {
  if (!state_.stage) return;
  const bool wanted = state_.debug_view.what != DebugView::color;
  if (wanted == state_.stage->debug_views.has_value()) {
    if (preparing_debug_views_) worker_.abandon(JobKind::debug_view);
    preparing_debug_views_.reset();
    return;
  }
  if (preparing_debug_views_ == wanted) return;
  preparing_debug_views_ = wanted;
  const auto failed = [this, wanted, left = drawn_debug_view_.what](const std::string& reason) {
    // Back to the view that the renderer can draw; the user may then try again.
    if (wanted)
      state_.debug_view.what = DebugView::color;
    else if (!why_not(left, state_.source))
      state_.debug_view.what = left;
    state_.error(wanted ? "The debug view cannot be shown" : "The colours cannot be shown", reason);
  };
  prepare(JobKind::debug_view, wanted, failed);
}

void Application::compare_when_needed() {
  Comparison& comparison = state_.comparison;
  const Photograph* photograph = state_.photograph();
  if (!photograph || comparison.show == Comparison::Show::off || !state_.stage) return;
  if (comparison.photograph != state_.recorded) try {
      comparison.texture = ImageTexture(photograph->image());
      comparison.photograph = state_.recorded;
      comparison.forget();
    } catch (const InputError& error) {  // its temporary file
      comparison.show = Comparison::Show::off;
      return state_.error("The photograph cannot be shown", error.reason());
    }
  if (comparison.result || comparison.asked) return;
  if (state_.stage->debug_views) return;  // its renderer is not that of the drawing choice
  comparison.asked = true;
  Renderer& renderer = state_.stage->renderer;
  try {
    renderer.draw({photograph->camera});
  } catch (const DeviceLimitError& error) {
    comparison.show = Comparison::Show::off;
    image_is_current_ = false;  // the targets of the window's image are gone
    state_.error("The photograph cannot be compared", error.reason());
    return;
  }
  const int ticket = comparison.ticket;
  auto drawn = std::make_shared<Image8>(renderer.read_color());
  image_is_current_ = false;  // the renderer now has the photograph's view
  const glm::vec3 background = background_of(state_.source);
  const auto work = [this, drawn, held = photograph->image, background,
                     ticket](const Worker::Progress&) {
    const ImageF ours = composited(to_float(*drawn), background);
    const ImageF theirs = composited(to_float(held()), background);
    const Metrics metrics = compare(ours, theirs, {.with_flip = false});
    auto map = std::make_shared<Image8>(difference(ours, theirs));
    return Worker::Completion([this, metrics, map, ticket] {
      if (state_.comparison.ticket != ticket) return;  // the view has changed
      state_.comparison.result = Comparison::Result{metrics, ImageTexture(*map)};
    });
  };
  const auto failed = [this](const std::string& reason) {
    state_.error("The photograph cannot be compared", reason);
  };
  worker_.start({.kind = JobKind::comparison, .what = "comparing", .work = work, .failed = failed});
}

}  // namespace tureen::viewer
