#include "splatting/layer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "splatting/discs/disc_layer.hpp"
#include "splatting/gaussians/gaussian_layer.hpp"
#include "splatting/gaussians/gaussian_rows.hpp"
#include "splatting/neural/neural_layer.hpp"
#include "splatting/windows/window_layer.hpp"

namespace tureen::splatting {

bool has_layer_for(const Splats& splats) { return count(splats) <= place_mask; }

namespace {

template <class Vector>
bool any_nan(const Vector& v) {
  for (int i = 0; i < v.length(); ++i)
    if (std::isnan(v[i])) return true;
  return false;
}

bool has_nan(const Splats& splats, std::size_t i) {
  const std::size_t per_splat = coefficients_per_splat(splats.color);
  for (std::size_t k = 0; k < per_splat; ++k)
    if (any_nan(splats.color.coefficients[per_splat * i + k])) return true;
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    return any_nan(windows->corners[3 * i]) || any_nan(windows->corners[3 * i + 1]) ||
           any_nan(windows->corners[3 * i + 2]) || std::isnan(windows->sigma[i]) ||
           std::isnan(windows->opacity[i]);
  if (const auto* densities = std::get_if<NeuralDensities>(&splats.kernel)) {
    const float* network = &densities->networks[NeuralDensities::parameters * i];
    return any_nan(densities->centers[i]) || any_nan(densities->semi_axes[i]) ||
           any_nan(densities->rotations[i]) ||
           std::any_of(network, network + NeuralDensities::parameters,
                       [](float value) { return std::isnan(value); });
  }
  const auto& gaussians = std::get<Gaussians>(splats.kernel);
  return any_nan(gaussians.centers[i]) || any_nan(gaussians.scales[i]) ||
         any_nan(gaussians.rotations[i]) || std::isnan(gaussians.opacity[i]);
}

}  // namespace

std::vector<std::uint32_t> without_nan(const Splats& splats, std::span<const std::uint32_t> which) {
  std::vector<std::uint32_t> result;
  std::copy_if(which.begin(), which.end(), std::back_inserter(result),
               [&](std::uint32_t i) { return !has_nan(splats, i); });
  return result;
}

LayerData layer_data(const Splats& splats, const SplatProfile& profile,
                     std::span<const std::uint32_t> which, int degree) {
  assert(has_layer_for(splats));
  const std::vector<std::uint32_t> kept = without_nan(splats, which);
  const SplatColor& color = splats.color;
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    return {color.per_corner ? LayerKind::corner_color_windows : LayerKind::windows, degree,
            rows_of(*windows, color, kept, degree)};
  if (const auto* densities = std::get_if<NeuralDensities>(&splats.kernel))
    return {LayerKind::densities, degree, rows_of(*densities, color, kept, degree)};
  const bool on_plane = profile.projection == SplatProfile::Projection::plane;
  return {on_plane ? LayerKind::discs : LayerKind::gaussians, degree,
          rows_of(std::get<Gaussians>(splats.kernel), color, kept, degree)};
}

std::unique_ptr<Layer> make_layer(LayerData data) {
  switch (data.kind) {
    case LayerKind::windows:
      return std::make_unique<WindowLayer<OneColorWindows>>(std::move(data));
    case LayerKind::corner_color_windows:
      return std::make_unique<WindowLayer<CornerColorWindows>>(std::move(data));
    case LayerKind::discs:
      return std::make_unique<DiscLayer>(std::move(data));
    case LayerKind::gaussians:
      return std::make_unique<GaussianLayer>(std::move(data));
    case LayerKind::densities:
      return std::make_unique<NeuralLayer>(std::move(data));
  }
  return nullptr;
}

}  // namespace tureen::splatting
