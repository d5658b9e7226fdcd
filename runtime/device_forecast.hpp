// Memory of a planned layer on a device, computed without a device.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/plan/plan.hpp"

namespace tureen {

struct DeviceForecast {
  /// Bytes of the scene's buffers and textures, without targets and without the padding of a
  /// texture's last row or layer. Renderer::device_bytes() is larger by at most 8 MiB a texture.
  std::uint64_t bytes = 0;
  /// The largest texel store, in texels and by name ("lattice texels"). It decides whether the
  /// scene fits, see texel_capacity().
  std::uint64_t largest_store_texels = 0;
  std::string largest_store;
};

/// The forecast for this soup with its plan from make_plan.
DeviceForecast device_forecast(const TriangleSoup& soup, const SoupPlan& plan);

/// The forecast for these splats with their plan from make_splat_plan.
DeviceForecast device_forecast(const Splats& splats, const SplatPlan& plan);

/// Largest number of texels in one store on such a device.
std::uint64_t texel_capacity(const DeviceLimits& limits);

}  // namespace tureen
