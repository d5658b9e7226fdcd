#include "runtime/plan/plan.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "runtime/plan/plan_draft.hpp"
#include "splatting/layer.hpp"

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
  for (const std::shared_ptr<LayerPlan>& layer : layers)
    std::visit(
        [&](const auto& plan) { all.insert(all.end(), plan.applied.begin(), plan.applied.end()); },
        *layer);
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

/// Whether tiles can, and by the preferences may, blend the splats. Throws UsageError as make_plan.
bool is_for_tiles(const Splats& splats, const DeviceLimits& limits,
                  const PlanPreferences& preferences) {
  const SplatBlending blending = preferences.splat_blending;
  const Quality::SplatOrder order = preferences.quality.splat_order;
  if (order == Quality::SplatOrder::stochastic) {
    if (blending == SplatBlending::tiles)
      throw UsageError("tiles do not draw stochastic splats",
                       "use --blend raster or auto, or another splat order");
    return false;
  }
  const bool exact = order == Quality::SplatOrder::exact;
  if (exact && blending == SplatBlending::raster)
    throw UsageError("raster does not blend splats in exact order",
                     "use --blend tiles or auto, or another splat order");
  if (!exact && (blending == SplatBlending::raster ||
                 (blending == SplatBlending::automatic && !limits.software)))
    return false;
  if (!preferences.as_published && splatting::has_layer_for(splats)) return true;
  if (blending == SplatBlending::tiles || exact)
    throw UsageError(
        preferences.as_published
            ? "tiles do not have the culls of published rasterisers"
            : "tiles blend at most " + std::to_string(splatting::place_mask) + " splats",
        exact ? "use another splat order: the exact one needs tiles"
              : "--blend raster can, and auto chooses it");
  return false;
}

/// Whether raster skips splats behind closed pixels. On hardware, the gain is not measured.
bool skips_hidden_splats(const DeviceLimits& limits, const PlanPreferences& preferences) {
  return limits.software && preferences.quality.splat_order != Quality::SplatOrder::stochastic &&
         preferences.specialise && preferences.specialisations.has(Specialisation::hidden_splats);
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
  const PlacedLayer one{.soup = &soup};
  return make_plan(std::span(&one, 1), limits, preferences);
}

RenderPlan make_plan(std::span<const PlacedLayer> layers, const DeviceLimits& limits,
                     const PlanPreferences& preferences) {
  if (layers.size() > max_layers)
    throw UsageError("the scene has " + std::to_string(layers.size()) + " layers; at most " +
                     std::to_string(max_layers) + " can be drawn together");
  if (const auto reason = defect(preferences.quality)) throw UsageError(*reason);
  RenderPlan plan;
  plan.reversed_depth = limits.clip_control && preferences.reversed_depth;
  plan.quality = preferences.quality;
  plan.specialise = preferences.specialise;
  plan.requested_stage = preferences.shading_stage;
  std::size_t soups = 0, for_tiles = 0;
  for (const PlacedLayer& layer : layers) {
    if (layer.soup) {
      ++soups;
      plan.add(make_soup_plan(*layer.soup, limits, preferences));
      continue;
    }
    plan.add(make_splat_plan(*layer.splats, {.specialise = preferences.specialise,
                                             .specialisations = preferences.specialisations,
                                             .profile = preferences.splat_profile,
                                             .as_published = preferences.as_published}));
    if (is_for_tiles(*layer.splats, limits, preferences)) ++for_tiles;
  }
  plan.splats_in_tiles =
      blends_in_tiles(plan.quality.splat_order, layers.size() - soups, for_tiles);
  for (const std::shared_ptr<LayerPlan>& layer : plan.layers) {
    auto* const soup = std::get_if<SoupPlan>(layer.get());
    if (soup && soups > 1) make_layered(*soup);
    if (!soup && !plan.splats_in_tiles && skips_hidden_splats(limits, preferences))
      std::get<SplatPlan>(*layer).applied.push_back({Specialisation::hidden_splats, 0, 0, 0.5});
  }
  return plan;
}

}  // namespace tureen
