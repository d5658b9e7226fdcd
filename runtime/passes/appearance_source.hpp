// An appearance before there is a device: what its texel stores will hold, in slot order, and the
// shader text that reads them. runtime/passes/device_appearance.hpp puts it on a device.
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

  /// Stands for #include "appearance.glsl": fragment_exists() and fragment_color().
  std::string glsl;
  /// What that text wants defined.
  std::map<std::string, std::string> constants;
  std::vector<Sampler> samplers;
  ColorMlpSource mlp;  // its uniforms
  TexelLayout layout;  // of all stores

  /// Takes the layers that fit the stores, of those that the device has; at last, when all stores
  /// are there.
  void fit_layout(const TexelLayout& device);
};

/// The sources read the soup and the elements of plan.faces, which must outlive them where they
/// are; the plan itself may be moved. Throws DeviceLimitError.
AppearanceSource prepare_appearance(const TriangleSoup& soup, const RenderPlan& plan,
                                    const TexelLayout& layout);

}  // namespace tureen
