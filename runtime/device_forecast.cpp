#include "runtime/device_forecast.hpp"

#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/texel_store.hpp"
#include "runtime/splats/device_splats.hpp"

namespace tureen {

DeviceForecast device_forecast(const TriangleSoup& soup, const SoupPlan& plan) {
  DeviceForecast result;
  result.bytes = plan.faces.size() * sizeof(FaceCorners);
  if (plan.drops_small_triangles) result.bytes *= 2;  // CoveredFaces keeps a copy
  // Layers for as many texels as shaders count: the forecast also serves for what does not fit.
  const TexelLayout unlimited{.max_layers = 1 << 11};
  const AppearanceSource appearance = prepare_appearance(soup, plan, unlimited);
  for (const auto& [name, source] : appearance.samplers) {
    result.bytes += source.count * source.format.bytes;
    if (source.count <= result.largest_store_texels) continue;
    result.largest_store_texels = source.count;
    result.largest_store = source.what;
  }
  return result;
}

DeviceForecast device_forecast(const Splats& splats, const SplatPlan& plan) {
  const TexelLayout layout;
  const SplatSource source = prepare_splats(splats, plan, layout);
  const TexelSource& largest =
      source.kernel.count > source.coefficients.count ? source.kernel : source.coefficients;
  return {.bytes = source.kernel.count * source.kernel.format.bytes +
                   source.coefficients.count * source.coefficients.format.bytes +
                   plan.drawn.size() * projected_bytes(plan),
          .largest_store_texels = largest.count,
          .largest_store = largest.what};
}

std::uint64_t texel_capacity(const DeviceLimits& limits) {
  return TexelLayout::of(limits).capacity();
}

}  // namespace tureen
