// The ray-traced image: its switch and progress, and its place over that of the rasteriser.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void tracing_rows(State& state) {
  check("Trace", &state.trace);
  tip("Ray-trace still views and saved images: mirrors, glass, splats in exact order per pixel");
  if (!state.trace) return;
  const TracedView& traced = state.traced;
  if (state.stage->debug_views) {
    aside("Debug views are not ray-traced.");
  } else if (state.shows_checks) {
    aside("The view over the checkerboard is not ray-traced.");
  } else if (traced.samples > 0) {
    aside(fmt::format("{} of {} samples per pixel", traced.samples, traced.wanted));
  } else {
    aside(traced.texture ? "Preview; refining" : "Tracing starts when the view is still.");
    progress_bar(traced.sharp);
  }
}

std::string tracing_text(const TracedView& traced) {
  if (traced.is_complete) return " \u00b7 ray-traced";
  if (!traced.is_running) return {};
  if (traced.samples > 0)
    return fmt::format(" \u00b7 ray tracing, {} of {} samples", traced.samples, traced.wanted);
  return fmt::format(" \u00b7 ray tracing, {:.0f} %", 100 * traced.sharp);
}

void traced_overlay(const State& state) {
  if (state.traced.texture)
    ImGui::GetBackgroundDrawList()->AddImage(state.traced.texture.id(), {0, 0},
                                             {float(state.points.x), float(state.points.y)});
}

}  // namespace tureen::viewer
