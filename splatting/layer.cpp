#include "splatting/layer.hpp"

#include <cassert>

#include "splatting/disc_layer.hpp"
#include "splatting/gaussian_layer.hpp"
#include "splatting/window_layer.hpp"

namespace tureen::splatting {

bool has_layer_for(const Splats& splats, const SplatProfile& profile) {
  if (std::holds_alternative<NeuralDensities>(splats.kernel) || splats.color.per_corner ||
      count(splats) > place_mask)
    return false;
  return !std::holds_alternative<TriangleWindows>(splats.kernel) || profile.min_center_depth > 0;
}

std::unique_ptr<Layer> make_layer(const Splats& splats, const SplatProfile& profile,
                                  std::span<const std::uint32_t> which, int degree) {
  assert(has_layer_for(splats, profile));
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    return std::make_unique<WindowLayer>(*windows, splats.color, which, degree);
  const auto& gaussians = std::get<Gaussians>(splats.kernel);
  if (profile.projection == SplatProfile::Projection::plane)
    return std::make_unique<DiscLayer>(gaussians, splats.color, which, degree);
  return std::make_unique<GaussianLayer>(gaussians, splats.color, which, degree);
}

}  // namespace tureen::splatting
