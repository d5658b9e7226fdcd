// What a planned soup takes on a device, told without one.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/plan/plan.hpp"

namespace tureen {

struct DeviceForecast {
  /// Buffers and textures of the scene, without targets and without the padding of a texture's
  /// last row or layer: Renderer::device_bytes() is larger by at most 8 MiB a texture.
  std::uint64_t bytes = 0;
  /// The longest texel store, in texels and in words ("lattice texels"): it decides whether the
  /// scene fits, see texel_capacity().
  std::uint64_t largest_store_texels = 0;
  std::string largest_store;
};

/// For the plan of our own pipeline made for this soup.
DeviceForecast device_forecast(const TriangleSoup& soup, const RenderPlan& plan);

/// The most texels that one store can hold on such a device.
std::uint64_t texel_capacity(const DeviceLimits& limits);

}  // namespace tureen
