#include "runtime/passes/device_appearance.hpp"

#include "runtime/gl/state.hpp"

namespace tureen {

DeviceAppearance::DeviceAppearance(AppearanceSource source)
    : glsl(std::move(source.glsl)),
      constants(std::move(source.constants)),
      mlp(std::move(source.mlp)) {
  for (AppearanceSource::Sampler& sampler : source.samplers) {
    samplers.push_back({std::move(sampler.name), TexelStore(source.layout, sampler.source)});
    sampler.source.fill = nullptr;  // frees its data after the upload
  }
}

std::size_t DeviceAppearance::device_bytes() const {
  std::size_t total = 0;
  for (const Sampler& sampler : samplers) total += sampler.store.device_bytes();
  return total;
}

void DeviceAppearance::bind(const gl::Program& program) const {
  for (std::size_t unit = 0; unit < samplers.size(); ++unit) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D_ARRAY, samplers[unit].store.texture());
    gl::use_texture_sampling(static_cast<unsigned>(unit));
    program.set(samplers[unit].name.c_str(), static_cast<int>(unit));
  }
  if (!mlp.weights.empty()) {
    program.set("mlp_weights", std::span<const glm::mat4>(mlp.weights));
    program.set("mlp_biases", std::span<const glm::vec4>(mlp.biases));
  }
}

}  // namespace tureen
