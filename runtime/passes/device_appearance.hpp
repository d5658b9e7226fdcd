// An appearance on the device.
#pragma once

#include "runtime/gl/program.hpp"
#include "runtime/passes/appearance_source.hpp"

namespace tureen {

struct DeviceAppearance {
  struct Sampler {
    std::string name;  // of the uniform
    TexelStore store;
  };

  std::string glsl;                              // as in AppearanceSource
  std::map<std::string, std::string> constants;  // likewise
  std::vector<Sampler> samplers;
  ColorMlpSource mlp;

  /// Reads the source's texels; they are not needed afterwards. Throws DeviceLimitError.
  explicit DeviceAppearance(AppearanceSource source);

  std::size_t device_bytes() const;
  /// Binds the stores to units 0.. and sets samplers and network weights of `program`, which is in
  /// use.
  void bind(const gl::Program& program) const;
  /// The first texture unit that bind() leaves free.
  int unit_count() const { return static_cast<int>(samplers.size()); }
};

}  // namespace tureen
