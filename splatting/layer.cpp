#include "splatting/layer.hpp"

#include "splatting/disc_layer.hpp"
#include "splatting/gaussian_layer.hpp"
#include "splatting/window_layer.hpp"

namespace tureen::splatting {

std::unique_ptr<Layer> make_layer(const Splats& splats, std::span<const std::uint32_t> which,
                                  int degree) {
  if (std::holds_alternative<NeuralDensities>(splats.kernel) || splats.color.per_corner ||
      which.size() > place_mask)
    return nullptr;
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
    if (splats.profile.min_center_depth == 0) return nullptr;
    return std::make_unique<WindowLayer>(*windows, splats.color, which, degree);
  }
  const auto& gaussians = std::get<Gaussians>(splats.kernel);
  if (splats.profile.projection == SplatProfile::Projection::plane)
    return std::make_unique<DiscLayer>(gaussians, splats.color, which, degree);
  return std::make_unique<GaussianLayer>(gaussians, splats.color, which, degree);
}

}  // namespace tureen::splatting
