// The colours and shapes of the window: the page's palette (web/page/style/palette.css), light and
// dark, for Dear ImGui. tests/viewer/theme_test.cpp compares the values with those of the page.
#pragma once

#include <array>
#include <cstdint>

namespace tureen::viewer {

/// Nothing portable reports the theme of the desktop, so the window has a setting.
enum class Theme { dark, light };
/// In the order of Theme: in the settings file.
inline constexpr std::array<const char*, 2> theme_names = {"dark", "light"};

/// Colours as 0xrrggbb, with the names of the page's variables.
struct Palette {
  std::uint32_t page, card, tint, line, edge, ink, faint, accent, on_accent, accent_tint, danger,
      danger_tint;
};
const Palette& palette(Theme theme);

/// Sets the colours of the current Dear ImGui context.
void set_colors(Theme theme);
/// Sets its rounded corners and distances. `scale`: 1..4.
void set_shapes(double scale);

}  // namespace tureen::viewer
