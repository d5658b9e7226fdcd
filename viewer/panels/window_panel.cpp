// Settings of the window itself.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void window_panel(State& state) {
  static constexpr const char* themes[] = {"Dark", "Light"};
  int theme = static_cast<int>(state.settings.theme);
  if (segments("theme", themes, theme)) state.settings.theme = static_cast<Theme>(theme);
  tip("T: light or dark theme");
  check("Smooth motion", &state.settings.smooth_motion);
  check("Vsync", &state.settings.vsync);
}

}  // namespace tureen::viewer
