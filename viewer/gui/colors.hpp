// Conversion of the theme's colours for Dear ImGui.
#pragma once

#include <imgui/imgui.h>

#include <cstdint>

namespace tureen::viewer {

/// `rgb`: 0xrrggbb. `alpha`: 0..1.
inline ImVec4 color_of(std::uint32_t rgb, float alpha = 1) {
  const auto channel = [rgb](int shift) { return float(rgb >> shift & 0xff) / 255.0f; };
  return {channel(16), channel(8), channel(0), alpha};
}

}  // namespace tureen::viewer
