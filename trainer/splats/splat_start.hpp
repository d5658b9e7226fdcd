// The scenes with which the training of a kernel can begin.
#pragma once

#include "scene/splats.hpp"
#include "trainer/splats/gaussians/gaussian_config.hpp"
#include "trainer/splats/windows/window_config.hpp"

namespace tureen::trainer {

/// The kernel that a configuration trains, as kernel_name().
inline const char* kernel_of(const GaussianConfig& config) {
  return config.flat ? "flat Gaussians" : "Gaussians";
}
inline const char* kernel_of(const WindowConfig&) { return "triangle windows"; }

/// Whether the splats have the kernel that the configuration trains.
inline bool has_own_kernel(const Splats& splats, const GaussianConfig& config) {
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  return gaussians && gaussians->flat == config.flat;
}
inline bool has_own_kernel(const Splats& splats, const WindowConfig&) {
  return std::holds_alternative<TriangleWindows>(splats.kernel);
}

/// Whether the splats can be the first ones: of the own kernel, with one colour each.
template <class Config>
bool can_begin_with(const Splats& splats, const Config& config) {
  return has_own_kernel(splats, config) && !splats.color.per_corner;
}

}  // namespace tureen::trainer
