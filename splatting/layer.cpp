#include "splatting/layer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <utility>
#include <vector>

#include "splatting/discs/disc_kernels.hpp"
#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/kernel_layer.hpp"
#include "splatting/kernel_rows.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "splatting/windows/corner_window_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen::splatting {

bool has_layer_for(const Splats& splats) { return count(splats) <= place_mask; }

namespace {

bool has_nan(const Splats& splats, std::size_t i) {
  bool found = false;
  for_each_column(splats.kernel, [&](const auto& column) {
    const std::span<const float> values = column.of_splat(i);
    found =
        found || std::any_of(values.begin(), values.end(), [](float v) { return std::isnan(v); });
  });
  const std::size_t per_splat = coefficients_per_splat(splats.color);
  const glm::vec3* coefficients = splats.color.coefficients.data() + per_splat * i;
  return found || std::any_of(coefficients, coefficients + per_splat,
                              [](const glm::vec3& each) { return glm::any(glm::isnan(each)); });
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
  return {kind_of(splats, profile), degree, rows_of(splats, kept, degree)};
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
