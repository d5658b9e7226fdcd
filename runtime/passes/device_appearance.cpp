#include "runtime/passes/device_appearance.hpp"

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
  int unit = 0;
  for (const Sampler& sampler : samplers)
    program.set_texture(sampler.name.c_str(), unit++, sampler.store.texture(), GL_TEXTURE_2D_ARRAY);
  if (!mlp.weights.empty()) {
    program.set("mlp_weights", std::span<const glm::mat4>(mlp.weights));
    program.set("mlp_biases", std::span<const glm::vec4>(mlp.biases));
  }
}

}  // namespace tureen
