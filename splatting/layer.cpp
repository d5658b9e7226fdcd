#include "splatting/layer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>

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

template <class Kernel>
constexpr KernelFacts facts{Kernel::shaders,
                            Kernel::texel_rows,
                            Kernel::points,
                            Kernel::colors,
                            [](const Splats& splats, const SplatProfile& profile) {
                              return std::holds_alternative<typename Kernel::Of>(splats.kernel) &&
                                     profile.projection == Kernel::projection &&
                                     splats.color.per_corner == (Kernel::colors > 1);
                            },
                            [](LayerData&& data) -> std::unique_ptr<Layer> {
                              return std::make_unique<KernelLayer<Kernel>>(std::move(data));
                            }};

/// The kernels, by LayerKind.
constexpr KernelFacts kernels[] = {
    facts<WindowKernel>,   facts<CornerWindowKernel>, facts<DiscKernel>,
    facts<GaussianKernel>, facts<NeuralKernel>,
};

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

LayerKind kind_of(const Splats& splats, const SplatProfile& profile) {
  const auto* found = std::find_if(std::begin(kernels), std::end(kernels),
                                   [&](const auto& each) { return each.draws(splats, profile); });
  assert(found != std::end(kernels));
  return LayerKind(found - std::begin(kernels));
}

const KernelFacts& facts_of(LayerKind kind) { return kernels[kind]; }

std::unique_ptr<Layer> make_layer(LayerData data) {
  return facts_of(data.kind).make(std::move(data));
}

}  // namespace tureen::splatting
