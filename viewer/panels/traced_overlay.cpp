// Draws the image by rays over that of the rasteriser.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void traced_overlay(const State& state) {
  if (state.traced.texture)
    ImGui::GetBackgroundDrawList()->AddImage(state.traced.texture.id(), {0, 0},
                                             {float(state.points.x), float(state.points.y)});
}

}  // namespace tureen::viewer
