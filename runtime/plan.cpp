#include "runtime/plan.hpp"

#include "runtime/color_mlp_source.hpp"
#include "runtime/plan_draft.hpp"
#include "soup/error.hpp"

namespace tureen {

namespace {

void choose_site(PlanDraft& draft) {
  RenderPlan& plan = draft.plan;
  // One or three reads make a colour: a second pass over the pixels costs more than it saves.
  const bool cheap = plan.flat_colors ||
                     std::holds_alternative<VertexColors>(draft.soup.appearance) ||
                     (std::holds_alternative<UvTextures>(draft.soup.appearance) && !plan.color_mlp);
  const bool forward =
      cheap && (draft.may(Specialisation::shading_pass) || !draft.preferences.specialise);
  const std::optional<ShadingSite> wanted = draft.preferences.site;
  plan.site = wanted.value_or(forward ? ShadingSite::forward : ShadingSite::deferred);
  plan.depth_rejects_background =
      draft.may(Specialisation::background) && plan.site == ShadingSite::deferred;
  if (plan.depth_rejects_background)
    draft.apply(Specialisation::background,
                "shading of background pixels, the depth test rejects them (exact)");
  if (draft.preferences.specialise && !wanted && plan.site == ShadingSite::forward)
    draft.apply(
        Specialisation::shading_pass,
        "the shading pass, colours are cheap enough to write at once (exact but for rounding)");
}

void choose_stage(PlanDraft& draft, const DeviceLimits& limits) {
  RenderPlan& plan = draft.plan;
  const ShadingStage wanted = draft.preferences.shading_stage;
  if (wanted == ShadingStage::compute && !limits.compute_shaders)
    throw DeviceLimitError(
        "shading as compute needs compute shaders, OpenGL 4.3 or ES 3.1, which this device has "
        "not");
  if (plan.site != ShadingSite::deferred) {
    if (wanted == ShadingStage::compute)
      draft.say("nothing is shaded as compute, as colours are written at once");
    return;
  }
  if (wanted == ShadingStage::compute) draft.say("shading runs as compute, as asked");
  plan.shading_stage = wanted;
}

void plan_quality(PlanDraft& draft) {
  draft.plan.quality = draft.preferences.quality;
  if (draft.plan.quality.resolution_scale < 1)
    draft.say("draws " + describe(draft.plan.quality) + " and enlarges the image bilinearly");
  if (draft.plan.quality.supersampling > 1) draft.say("draws " + describe(draft.plan.quality));
}

void describe_drawing(PlanDraft& draft) {
  RenderPlan& plan = draft.plan;
  std::string sentence = formatted("draws %zu of %zu faces (%s), near ones first in %zu clusters, ",
                                   plan.faces.size(), draft.soup.triangles.size(),
                                   appearance_name(draft.soup.appearance), plan.clusters.size());
  sentence += plan.site == ShadingSite::forward    ? "colour in one pass"
              : plan.site == ShadingSite::deferred ? "a visibility pass, then colour once a pixel"
                                                   : "no colours, an empty fragment shader";
  if (plan.color_mlp && plan.site != ShadingSite::nowhere) sentence += " by the color MLP";
  sentence += plan.reversed_depth ? "; reversed depth" : "; ordinary depth range";
  if (!draft.preferences.specialise) sentence += "; nothing is left out, as asked";
  plan.sentences.insert(plan.sentences.begin(), std::move(sentence));
}

}  // namespace

void plan_appearance(PlanDraft& draft, const FaceColors&) { draft.plan.flat_colors = true; }

void plan_appearance(PlanDraft& draft, const VertexColors& colors) {
  RenderPlan& plan = draft.plan;
  if (!draft.may(Specialisation::interpolation) || plan.opaque_count < plan.faces.size()) return;
  for (const std::uint32_t t : plan.faces) {
    const glm::uvec3& v = draft.soup.triangles[t];
    if (colors.rgba[v.x] != colors.rgba[v.y] || colors.rgba[v.x] != colors.rgba[v.z]) return;
  }
  plan.flat_colors = true;
  draft.apply(Specialisation::interpolation,
              "interpolation, the three vertex colours of every face are equal (exact)");
}

void plan_appearance(PlanDraft& draft, const UvTextures& textures) {
  draft.plan.color_mlp = textures.mlp.has_value();
  if (draft.plan.color_mlp) plan_network(draft, *textures.mlp, {});
}

RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences) {
  if (const auto reason = defect(preferences.quality)) throw UsageError(*reason);
  PlanDraft draft{soup, preferences, {}};
  draft.plan.pipeline = preferences.pipeline;
  if (preferences.pipeline == PipelineKind::published) {
    plan_published(draft);
    plan_quality(draft);
    return std::move(draft.plan);
  }
  draft.plan.reversed_depth = limits.clip_control && preferences.reversed_depth;
  plan_faces(draft, limits);
  std::visit([&](const auto& appearance) { plan_appearance(draft, appearance); }, soup.appearance);
  choose_site(draft);
  plan_quality(draft);
  choose_stage(draft, limits);
  describe_drawing(draft);
  return std::move(draft.plan);
}

}  // namespace tureen
