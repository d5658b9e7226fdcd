#include "runtime/plan/splat_plan.hpp"

#include <algorithm>
#include <span>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

SplatShaders shaders_of(const Splats& splats) {
  if (std::holds_alternative<TriangleWindows>(splats.kernel)) return SplatShaders::windows;
  if (std::holds_alternative<NeuralDensities>(splats.kernel)) return SplatShaders::neural_density;
  return splats.profile.projection == SplatProfile::Projection::plane ? SplatShaders::discs
                                                                      : SplatShaders::gaussians;
}

/// The opacities, or null for a kernel without.
const std::vector<float>* opacity_of(const SplatKernel& kernel) {
  if (const auto* windows = std::get_if<TriangleWindows>(&kernel)) return &windows->opacity;
  if (const auto* gaussians = std::get_if<Gaussians>(&kernel)) return &gaussians->opacity;
  return nullptr;
}

int degree_in_use(const SplatColor& color) {
  const std::size_t per_color = harmonics::count(color.degree);
  int degree = 0;
  for (std::size_t i = 0; i < color.coefficients.size() && degree < color.degree; ++i) {
    if (color.coefficients[i] == glm::vec3(0.0f)) continue;
    while (i % per_color >= std::size_t(harmonics::count(degree))) ++degree;
  }
  return degree;
}

}  // namespace

SplatPlan make_splat_plan(const Splats& splats, bool specialise) {
  SplatPlan plan;
  plan.shaders = shaders_of(splats);
  plan.profile = splats.profile;
  plan.kernel =
      std::string(kernel_name(splats.kernel)) + ", profile " + std::string(profile_name(splats));
  plan.splats = count(splats);
  plan.stored_degree = splats.color.degree;
  plan.harmonics_degree = specialise ? degree_in_use(splats.color) : splats.color.degree;
  plan.colors_per_splat = splats.color.per_corner ? 3 : 1;
  const std::vector<float>* opacity = specialise ? opacity_of(splats.kernel) : nullptr;
  plan.drawn.reserve(plan.splats);
  for (std::size_t i = 0; i < plan.splats; ++i)
    if (!opacity || (*opacity)[i] >= splats.profile.min_alpha)
      plan.drawn.push_back(std::uint32_t(i));
  const std::span<const std::uint32_t> drawn(plan.drawn);
  for (std::size_t i = 0; i < drawn.size(); i += splats_per_chunk)
    plan.chunks.push_back(
        bounds(splats, drawn.subspan(i, std::min(splats_per_chunk, drawn.size() - i))));
  return plan;
}

}  // namespace tureen
