#include "runtime/plan/plan.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/plan/plan_draft.hpp"

namespace tureen {

namespace {

void choose_site(PlanDraft& draft) {
  SoupPlan& plan = draft.plan;
  // A colour takes one or three reads, so a second pass over the pixels costs more than it saves.
  const bool cheap = plan.flat_colors ||
                     std::holds_alternative<VertexColors>(draft.soup.appearance) ||
                     (std::holds_alternative<UvTextures>(draft.soup.appearance) && !plan.color_mlp);
  const bool forward =
      cheap && (draft.may(Specialisation::shading_pass) || !draft.preferences.specialise);
  const std::optional<ShadingSite> wanted = draft.preferences.site;
  plan.site = wanted.value_or(forward ? ShadingSite::forward : ShadingSite::deferred);
  plan.depth_rejects_background =
      draft.may(Specialisation::background) && plan.site == ShadingSite::deferred;
  if (plan.depth_rejects_background) draft.apply({Specialisation::background});
  if (draft.preferences.specialise && !wanted && plan.site == ShadingSite::forward)
    draft.apply({Specialisation::shading_pass});
}

void choose_stage(PlanDraft& draft, const DeviceLimits& limits) {
  SoupPlan& plan = draft.plan;
  const ShadingStage wanted = draft.preferences.shading_stage;
  if (wanted == ShadingStage::compute && !limits.compute_shaders)
    throw DeviceLimitError(
        "shading as compute needs compute shaders (OpenGL 4.3 or ES 3.1), which this device lacks");
  if (plan.site == ShadingSite::deferred) plan.shading_stage = wanted;
}

}  // namespace

bool RenderPlan::applies(Specialisation what) const {
  const std::vector<AppliedSpecialisation> all = applied();
  return std::any_of(all.begin(), all.end(),
                     [what](const AppliedSpecialisation& each) { return each.what == what; });
}

std::vector<AppliedSpecialisation> RenderPlan::applied() const {
  std::vector<AppliedSpecialisation> all;
  for (const LayerPlan& layer : layers)
    std::visit(
        [&](const auto& plan) { all.insert(all.end(), plan.applied.begin(), plan.applied.end()); },
        layer);
  return all;
}

void plan_appearance(PlanDraft& draft, const FaceColors&) { draft.plan.flat_colors = true; }

void plan_appearance(PlanDraft& draft, const VertexColors& colors) {
  SoupPlan& plan = draft.plan;
  if (!draft.may(Specialisation::interpolation) || plan.opaque_count < plan.faces.size()) return;
  for (const std::uint32_t t : plan.faces) {
    const glm::uvec3& v = draft.soup.triangles[t];
    if (colors.rgba[v.x] != colors.rgba[v.y] || colors.rgba[v.x] != colors.rgba[v.z]) return;
  }
  plan.flat_colors = true;
  draft.apply({Specialisation::interpolation});
}

void plan_appearance(PlanDraft& draft, const UvTextures& textures) {
  draft.plan.color_mlp = textures.mlp.has_value();
  if (draft.plan.color_mlp) plan_network(draft, *textures.mlp, {});
}

namespace {

SoupPlan make_soup_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                        const PlanPreferences& preferences) {
  PlanDraft draft{soup, preferences, {}};
  draft.plan.appearance = appearance_name(soup.appearance);
  draft.plan.soup_faces = soup.triangles.size();
  plan_faces(draft, limits);
  std::visit([&](const auto& appearance) { plan_appearance(draft, appearance); }, soup.appearance);
  choose_site(draft);
  choose_stage(draft, limits);
  return std::move(draft.plan);
}

}  // namespace

void make_layered(SoupPlan& plan) {
  if (plan.site == ShadingSite::nowhere) return;  // triangles only, for all layers
  plan.site = ShadingSite::deferred;
  plan.shading_stage = ShadingStage::fragment;
  plan.depth_rejects_background = true;  // the stencil does
  std::erase_if(plan.applied, [](const AppliedSpecialisation& each) {
    return each.what == Specialisation::shading_pass;
  });
}

RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences) {
  const TriangleSoup* const one = &soup;
  return make_plan(std::span(&one, 1), limits, preferences);
}

RenderPlan make_plan(std::span<const TriangleSoup* const> soups, const DeviceLimits& limits,
                     const PlanPreferences& preferences) {
  if (soups.size() > max_layers)
    throw UsageError("the scene has " + std::to_string(soups.size()) + " layers; at most " +
                     std::to_string(max_layers) + " can be drawn together");
  if (const auto reason = defect(preferences.quality)) throw UsageError(*reason);
  RenderPlan plan;
  plan.reversed_depth = limits.clip_control && preferences.reversed_depth;
  plan.quality = preferences.quality;
  plan.specialise = preferences.specialise;
  plan.requested_stage = preferences.shading_stage;
  for (const TriangleSoup* soup : soups)
    plan.layers.push_back(make_soup_plan(*soup, limits, preferences));
  if (soups.size() > 1)
    for (LayerPlan& layer : plan.layers) make_layered(std::get<SoupPlan>(layer));
  return plan;
}

}  // namespace tureen
