#include "runtime/plan/splat_plan.hpp"

#include <algorithm>
#include <span>

#include "base/error.hpp"

namespace tureen {

namespace {

SplatShaders shaders_of(const SplatKernel& kernel, const SplatProfile& profile) {
  if (std::holds_alternative<TriangleWindows>(kernel)) return SplatShaders::windows;
  if (std::holds_alternative<NeuralDensities>(kernel)) return SplatShaders::neural_density;
  return profile.projection == SplatProfile::Projection::plane ? SplatShaders::discs
                                                               : SplatShaders::gaussians;
}

}  // namespace

SplatPlan make_splat_plan(const Splats& splats, const SplatPreferences& preferences) {
  const bool specialise = preferences.specialise;
  SplatPlan plan;
  plan.profile = preferences.profile.value_or(splats.profile);
  if (const auto reason = profile_defect(splats.kernel, plan.profile))
    throw UsageError("the splats cannot be drawn by this profile: " + *reason);
  plan.shaders = shaders_of(splats.kernel, plan.profile);
  plan.as_published = preferences.as_published;
  plan.kernel = std::string(kernel_name(splats.kernel)) + ", profile " +
                std::string(profile_name(splats.kernel, plan.profile)) +
                (plan.as_published ? " with its authors' culls" : "");
  plan.splats = count(splats);
  plan.stored_degree = splats.color.degree;
  plan.harmonics_degree = specialise ? degree_in_use(splats.color) : splats.color.degree;
  plan.colors_per_splat = splats.color.per_corner ? 3 : 1;
  const std::vector<float>* opacity = specialise ? opacity_of(splats.kernel) : nullptr;
  plan.drawn.reserve(plan.splats);
  for (std::size_t i = 0; i < plan.splats; ++i)
    if (!opacity || (*opacity)[i] >= plan.profile.min_alpha) plan.drawn.push_back(std::uint32_t(i));
  const std::span<const std::uint32_t> drawn(plan.drawn);
  for (std::size_t i = 0; i < drawn.size(); i += splats_per_chunk)
    plan.chunks.push_back(bounds(
        splats, drawn.subspan(i, std::min(splats_per_chunk, drawn.size() - i)), plan.profile));
  return plan;
}

}  // namespace tureen
