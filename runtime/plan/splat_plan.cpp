#include "runtime/plan/splat_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>

#include "base/error.hpp"
#include "scene/scene.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// SplatPlan::largest_color. The squares of the functions of band l add up to (2 l + 1) / (4 pi) in
/// every direction, which bounds the band by Cauchy's inequality.
float largest_color(const SplatColor& color, std::span<const std::uint32_t> drawn, int degree) {
  const auto per_color = std::size_t(harmonics::count(color.degree));
  const std::size_t colors = coefficients_per_splat(color) / per_color;
  float largest = 1;
  for (const std::uint32_t splat : drawn) {
    for (std::size_t i = colors * splat; i < colors * (splat + 1); ++i) {
      const glm::vec3* coefficient = &color.coefficients[per_color * i];
      glm::vec3 bound(0.5f + float(harmonics::y00) * coefficient[0]);
      for (int band = 1; band <= degree; ++band) {
        glm::vec3 squares(0.0f);
        for (int k = harmonics::count(band - 1); k < harmonics::count(band); ++k)
          squares += coefficient[k] * coefficient[k];
        bound += glm::sqrt(float(2 * band + 1) / (4 * glm::pi<float>()) * squares);
      }
      const float of_splat = std::max(bound.x, std::max(bound.y, bound.z));
      if (of_splat > largest) largest = of_splat;
    }
  }
  return largest;
}

}  // namespace

bool SplatPlan::applies(Specialisation what) const {
  return std::any_of(applied.begin(), applied.end(),
                     [&](const AppliedSpecialisation& each) { return each.what == what; });
}

bool blends_in_tiles(Quality::SplatOrder order, std::size_t layers, std::size_t for_tiles) {
  if (order == Quality::SplatOrder::stochastic || layers == 0) return false;
  if (for_tiles == layers) return true;
  if (order == Quality::SplatOrder::exact)
    throw UsageError("the exact order of splats needs tiles for all layers, and at most " +
                         std::to_string(max_layers) + " layers of splats",
                     "prepare added layers with the same quality");
  return false;
}

SplatPlan make_splat_plan(const Splats& splats, const SplatPreferences& preferences) {
  const auto may = [&](Specialisation what) {
    return preferences.specialise && preferences.specialisations.has(what);
  };
  SplatPlan plan;
  plan.profile = preferences.profile.value_or(splats.profile);
  if (const auto reason = profile_defect(splats.kernel, plan.profile))
    throw UsageError("the splats cannot be drawn by this profile: " + *reason);
  plan.kind = splatting::kind_of(splats, plan.profile);
  plan.as_published = preferences.as_published;
  plan.kernel = std::string(kernel_name(splats.kernel)) + ", profile " +
                std::string(profile_name(splats.kernel, plan.profile)) +
                (plan.as_published ? " with its authors' culls" : "");
  plan.splats = count(splats);
  plan.harmonics_degree = splats.color.degree;
  if (may(Specialisation::harmonics_bands)) plan.harmonics_degree = degree_in_use(splats.color);
  if (plan.harmonics_degree < splats.color.degree)
    plan.applied.push_back({Specialisation::harmonics_bands,
                            std::size_t(splats.color.degree - plan.harmonics_degree),
                            std::size_t(splats.color.degree)});
  plan.colors_per_splat = splats.color.per_corner ? 3 : 1;
  const std::vector<float>* opacity =
      may(Specialisation::transparent_splats) ? opacity_of(splats.kernel) : nullptr;
  plan.drawn.reserve(plan.splats);
  for (std::size_t i = 0; i < plan.splats; ++i)
    if (!opacity || (*opacity)[i] >= plan.profile.min_alpha) plan.drawn.push_back(std::uint32_t(i));
  if (plan.drawn.size() < plan.splats)
    plan.applied.push_back(
        {Specialisation::transparent_splats, plan.splats - plan.drawn.size(), plan.splats});
  const std::span<const std::uint32_t> drawn(plan.drawn);
  plan.largest_color = largest_color(splats.color, drawn, plan.harmonics_degree);
  for (std::size_t i = 0; i < drawn.size(); i += splats_per_chunk)
    plan.chunks.push_back(bounds(
        splats, drawn.subspan(i, std::min(splats_per_chunk, drawn.size() - i)), plan.profile));
  return plan;
}

}  // namespace tureen
