// The scenes with which the training of a kernel can begin.
#pragma once

#include "scene/splats.hpp"
#include "trainer/splats/gaussians/gaussian_config.hpp"
#include "trainer/splats/neural/neural_config.hpp"
#include "trainer/splats/windows/window_config.hpp"

namespace tureen::trainer {

/// The kernel that a configuration trains, as kernel_name().
inline const char* kernel_of(const GaussianConfig& config) {
  return config.flat ? "flat Gaussians" : "Gaussians";
}
inline const char* kernel_of(const NeuralConfig&) { return "neural densities"; }
inline const char* kernel_of(const WindowConfig&) { return "triangle windows"; }

/// The kernels of splats with which its training can begin.
template <class Config>
const char* starts_of(const Config& config) {
  return kernel_of(config);
}
inline const char* starts_of(const NeuralConfig&) { return "neural densities, Gaussians"; }

/// Whether the splats have such a kernel.
inline bool has_kernel_of_start(const Splats& splats, const GaussianConfig& config) {
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  return gaussians && gaussians->flat == config.flat;
}
inline bool has_kernel_of_start(const Splats& splats, const NeuralConfig&) {
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  return std::holds_alternative<NeuralDensities>(splats.kernel) || (gaussians && !gaussians->flat);
}
inline bool has_kernel_of_start(const Splats& splats, const WindowConfig&) {
  return std::holds_alternative<TriangleWindows>(splats.kernel);
}

/// Whether the splats can be the first ones: of such a kernel, with one colour each.
template <class Config>
bool can_begin_with(const Splats& splats, const Config& config) {
  return has_kernel_of_start(splats, config) && !splats.color.per_corner;
}

}  // namespace tureen::trainer
