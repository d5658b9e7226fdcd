#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "scene/spherical_harmonics.hpp"
#include "tracing/kernels/ray_kernel.hpp"
#include "tracing/layer.hpp"

namespace tureen::tracing {

const RayKernel& ray_kernel_of(const Primitives& primitives) {
  static constexpr const RayKernel* kernels[] = {&gaussian_rays,      &disc_rays,   &window_rays,
                                                 &corner_window_rays, &neural_rays, &triangle_rays};
  const auto* found = std::find_if(std::begin(kernels), std::end(kernels),
                                   [&](const RayKernel* each) { return each->draws(primitives); });
  assert(found != std::end(kernels));
  return **found;
}

glm::vec3 harmonics_color(const SplatColor& color, std::size_t element,
                          const glm::dvec3& from_eye) {
  const auto bands = std::size_t(harmonics::count(color.degree));
  const glm::vec3* coefficients = &color.coefficients[element * bands];
  glm::vec3 sum = 0.5f + float(harmonics::y00) * coefficients[0];
  if (color.degree > 0) {
    const double distance = glm::length(from_eye);
    const auto basis = harmonics::basis(distance > 0 ? glm::vec3(from_eye / distance)
                                                     : glm::vec3(0.0f, 0.0f, 1.0f));
    for (std::size_t k = 1; k < bands; ++k) sum += basis[k] * coefficients[k];
  }
  // This order of the arguments turns NaN into 0. As in the tiles, no product with it is infinite.
  for (int c = 0; c < 3; ++c) sum[c] = std::min(std::max(0.0f, sum[c]), 65504.0f);
  return sum;
}

glm::vec3 splat_color(const TracedLayer& layer, const RayInLayer& ray, std::uint32_t lane) {
  const auto& splats = std::get<Splats>(layer.primitives());
  const std::uint32_t i = layer.primitive(lane);
  const glm::dvec3 from_eye = splats.color.degree > 0 ? center(splats, i) - ray.eye : glm::dvec3(0);
  return harmonics_color(splats.color, i, from_eye);
}

float largest_squared(float opacity, const SplatProfile& profile) {
  return opacity > 0 ? 2 * std::log(opacity / profile.min_alpha) : -1.0f;
}

}  // namespace tureen::tracing
