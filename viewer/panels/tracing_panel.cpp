// The image by rays: its switch and progress, and its place over that of the rasteriser.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void tracing_rows(State& state) {
  check("Trace", &state.trace);
  tip("While nothing moves, draw by rays: mirrors, glass, and splats in their exact order at each "
      "pixel. Saved images are drawn in this way, too");
  if (!state.trace) return;
  const TracedView& traced = state.traced;
  if (state.stage->debug_views) {
    aside("Debug views are drawn without rays.");
  } else if (traced.samples > 0) {
    const char* ends = traced.is_complete ? "" : "; more follow";
    aside(
        fmt::format("By rays, {} of {} samples per pixel{}", traced.samples, traced.wanted, ends));
  } else {
    aside(traced.texture ? "By rays, coarse; becoming sharp" : "Rays begin when nothing moves.");
    progress_bar(traced.sharp);
  }
}

void traced_overlay(const State& state) {
  if (state.traced.texture)
    ImGui::GetBackgroundDrawList()->AddImage(state.traced.texture.id(), {0, 0},
                                             {float(state.points.x), float(state.points.y)});
}

}  // namespace tureen::viewer
