// An appearance on the device: texel stores in slot order, and the shader text that reads them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runtime/color_mlp_source.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/plan.hpp"
#include "runtime/texel_store.hpp"

namespace tureen {

struct DeviceAppearance {
  struct Sampler {
    const char* name;  // of the uniform
    TexelStore store;
  };

  /// Stands for #include "appearance.glsl": fragment_exists() and fragment_color().
  std::string glsl;
  /// What that text wants defined.
  std::map<std::string, std::string> constants;
  std::vector<Sampler> samplers;
  ColorMlpSource mlp;  // its uniforms

  std::size_t device_bytes() const;
  /// Binds the stores to units 0.. and sets samplers and network weights of `program`, in use.
  void bind(const gl::Program& program) const;
  /// The first texture unit that bind() leaves free.
  int unit_count() const { return static_cast<int>(samplers.size()); }
};

/// Throws DeviceLimitError.
DeviceAppearance upload_appearance(const TriangleSoup& soup, const RenderPlan& plan,
                                   const TexelLayout& layout);

}  // namespace tureen
