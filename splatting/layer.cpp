#include "splatting/layer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "splatting/discs/disc_kernels.hpp"
#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/kernel_layer.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "splatting/windows/corner_window_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

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

LayerKind kind_of(const Splats& splats, const SplatProfile& profile) {
  if (std::holds_alternative<TriangleWindows>(splats.kernel))
    return splats.color.per_corner ? LayerKind::corner_color_windows : LayerKind::windows;
  if (std::holds_alternative<NeuralDensities>(splats.kernel)) return LayerKind::densities;
  const bool on_plane = profile.projection == SplatProfile::Projection::plane;
  return on_plane ? LayerKind::discs : LayerKind::gaussians;
}

template <class Kernel>
std::unique_ptr<Layer> layer_of(LayerData&& data) {
  return std::make_unique<KernelLayer<Kernel>>(std::move(data));
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
  const auto rows = [&](const auto& kernel) { return rows_of(kernel, splats.color, kept, degree); };
  return {kind_of(splats, profile), degree, std::visit(rows, splats.kernel)};
}

std::unique_ptr<Layer> make_layer(LayerData data) {
  constexpr std::unique_ptr<Layer> (*makers[])(LayerData &&) = {
      &layer_of<WindowKernel>,        // windows
      &layer_of<CornerWindowKernel>,  // corner_color_windows
      &layer_of<DiscKernel>,          // discs
      &layer_of<GaussianKernel>,      // gaussians
      &layer_of<NeuralKernel>,        // densities
  };
  return makers[std::size_t(data.kind)](std::move(data));
}

}  // namespace tureen::splatting
