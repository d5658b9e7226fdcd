// An appearance before a device exists: the contents of its texel stores, in slot order, and the
// shader text that reads them. runtime/passes/device_soup.hpp uploads it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runtime/passes/texel_store.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

struct AppearanceSource {
  struct Sampler {
    std::string name;  // of the uniform
    TexelSource source;
  };

  /// Replaces #include "appearance.glsl": fragment_exists() and fragment_color().
  std::string glsl;
  /// Constants that the text needs.
  std::map<std::string, std::string> constants;
  std::vector<Sampler> samplers;
  ColorMlpSource mlp;  // its uniforms
  TexelLayout layout;  // shared by all stores

  /// Chooses the height of layers for the stores, within the device's layout. Called last, after
  /// all stores are complete.
  void fit_layout(const TexelLayout& device);
};

/// The sources read the soup and the elements of plan.faces. Both must outlive them without moving;
/// the plan object itself may be moved. Throws DeviceLimitError.
AppearanceSource prepare_appearance(const TriangleSoup& soup, const SoupPlan& plan,
                                    const TexelLayout& layout);

}  // namespace tureen
