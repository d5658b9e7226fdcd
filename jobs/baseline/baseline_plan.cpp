// The plan of the baseline, which has no specialisations.
#include "base/error.hpp"
#include "runtime/plan/face_alpha.hpp"
#include "runtime/plan/plan_draft.hpp"

namespace tureen {

void plan_baseline(PlanDraft& draft) {
  const TriangleSoup& soup = draft.soup;
  RenderPlan& plan = draft.plan;
  const auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
  if (!texture || !texture->mlp)
    throw UsageError(std::string("the baseline draws lattice textures with a color MLP; "
                                 "this soup has ") +
                     appearance_name(soup.appearance));
  if (draft.preferences.shading_stage == ShadingStage::compute)
    throw UsageError("the baseline shades in the fragment stage, never as compute");
  const std::uint32_t level = texture->patches.empty() ? 0 : texture->patches.front().level;
  for (const LatticePatch& patch : texture->patches)
    if (patch.level != level)
      throw UsageError("the baseline knows one lattice level for all faces");
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (drawable(soup, t)) plan.faces.push_back(t);
  plan.color_mlp = true;
  plan.lattice.uniform_level = int(level);
  plan.ignores_specialisations = draft.preferences.specialisations != SpecialisationSet::all();
}

}  // namespace tureen
