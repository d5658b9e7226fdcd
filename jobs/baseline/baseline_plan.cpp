// The plans of the baselines, and their English.
#include "base/error.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/plan/face_alpha.hpp"
#include "runtime/plan/plan_description.hpp"

namespace tureen {

namespace {

std::vector<std::string> description_of(const PlanPreferences& preferences) {
  std::vector<std::string> sentences{
      "baseline: two RGBA8 feature targets, every fragment samples all eight channels, faces in "
      "file order, the network on every pixel with its weights in uniforms"};
  for (std::string& sentence : describe_sampling(preferences.quality))
    sentences.push_back(std::move(sentence));
  if (preferences.specialisations != SpecialisationSet::all())
    sentences.emplace_back("--keep has no effect: the baseline has no specialisations");
  return sentences;
}

}  // namespace

RenderPlan make_baseline_plan(const TriangleSoup& soup, const PlanPreferences& preferences) {
  if (const auto reason = defect(preferences.quality)) throw UsageError(*reason);
  const auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
  if (!texture || !texture->mlp)
    throw UsageError(
        std::string("the baseline supports lattice textures with a color MLP; this soup has ") +
        appearance_name(soup.appearance));
  if (preferences.shading_stage == ShadingStage::compute)
    throw UsageError("the baseline does not support --shading compute");
  const std::uint32_t level = texture->patches.empty() ? 0 : texture->patches.front().level;
  for (const LatticePatch& patch : texture->patches)
    if (patch.level != level)
      throw UsageError("the baseline supports only one lattice level for all faces");
  SoupPlan layer;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (drawable(soup, t)) layer.faces.push_back(t);
  layer.site = ShadingSite::deferred;
  layer.color_mlp = true;
  layer.lattice.uniform_level = int(level);
  layer.appearance = appearance_name(soup.appearance);
  layer.soup_faces = soup.triangles.size();
  RenderPlan plan;
  plan.add(std::move(layer));
  plan.quality = preferences.quality;
  plan.specialise = preferences.specialise;
  plan.description = description_of(preferences);
  return plan;
}

RenderPlan make_baseline_plan(const Splats& splats, const PlanPreferences& preferences) {
  if (const auto reason = defect(preferences.quality)) throw UsageError(*reason);
  SplatPlan layer =
      make_splat_plan(splats, {.specialise = false, .profile = preferences.splat_profile});
  const std::string_view shaders = splatting::facts_of(layer.kind).shaders;
  if (shaders != "windows" && shaders != "gaussians")
    throw UsageError(
        "the baseline supports triangle windows, and Gaussians by EWA splatting; this scene has " +
        layer.kernel);
  if (splats.color.per_corner)
    throw UsageError("the baseline supports only one colour a window, not one a corner");
  if (preferences.as_published) throw UsageError("the baseline does not support --as-published");
  RenderPlan plan;
  plan.quality = preferences.quality;
  plan.quality.splat_order = Quality::SplatOrder::center;  // its own
  plan.specialise = preferences.specialise;
  plan.description = {"baseline: an instanced quad a splat (" + layer.kernel +
                      "), everything of a splat computed at its four vertices, blended from far to "
                      "near in 8 bits, in the order of 16-bit depths"};
  for (std::string& sentence : describe_sampling(preferences.quality))
    plan.description.push_back(std::move(sentence));
  if (preferences.splat_blending != SplatBlending::automatic)
    plan.description.emplace_back("--blend has no effect: the baseline blends in its own way");
  plan.add(std::move(layer));
  return plan;
}

RenderPlan make_baseline_plan(const Primitives& primitives, const PlanPreferences& preferences) {
  return std::visit([&](const auto& each) { return make_baseline_plan(each, preferences); },
                    primitives);
}

}  // namespace tureen
