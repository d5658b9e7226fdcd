#include "runtime/plan_description.hpp"

#include <algorithm>
#include <cassert>
#include <cstdio>

namespace tureen {

namespace {

/// printf's formatting into a string of at most 255 characters.
template <class... Values>
std::string formatted(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string margin_of(const AppliedSpecialisation& applied) {
  if (applied.margin > 0)
    return formatted(" (changes colours by at most %.3f of an 8-bit step)", applied.margin);
  return applied.what == Specialisation::shading_pass ? " (exact but for rounding)" : " (exact)";
}

/// The replacement that is drawn or computed.
std::string effect_of(const AppliedSpecialisation& applied) {
  const auto counted = [&](const char* what) {
    return formatted("%zu of %zu ", applied.count, applied.total) + what;
  };
  switch (applied.what) {
    case Specialisation::alpha_test:
      return counted("faces are opaque throughout and need no alpha test");
    case Specialisation::transparent_faces:
      return counted("faces are transparent throughout and not drawn");
    case Specialisation::coincident_faces:
      return counted("faces lie behind an opaque one with the same corners and are not drawn");
    case Specialisation::faces_between_pixels:
      return "faces that cover no pixel's centre are found in each frame and not drawn";
    case Specialisation::shading_pass:
      return "colours are written in the only pass, as they cost little";
    case Specialisation::background:
      return "the depth test rejects background pixels before shading";
    case Specialisation::interpolation:
      return "the three vertex colours of every face are equal and not interpolated";
    case Specialisation::harmonics_bands:
      return counted("harmonics bands are not evaluated");
    case Specialisation::color_mlp:
      return "the color MLP never blends in and does not run";
    case Specialisation::view_direction:
      return "the color MLP ignores the view direction";
    case Specialisation::weight_uniforms:
      return "the weights of the color MLP are constants of the shader";
    case Specialisation::dead_neurons:
      return counted("hidden neurons never fire and are not computed");
    case Specialisation::latent_features:
      return "features 4 and above are constant or have no weight, and are not read";
    case Specialisation::constant_lattices:
      return "every face has one colour and no lattice";
    case Specialisation::affine_texels:
      return counted("faces are affine and keep only their corner texels");
  }
  assert(!"a specialisation without a description");
  return {};
}

std::string describe_frame(const RenderPlan& plan) {
  if (plan.pipeline == PipelineKind::published)
    return "published pipeline: two RGBA8 feature targets, every fragment samples all eight "
           "channels, faces in file order, the network on every pixel with its weights in uniforms";
  std::string sentence =
      formatted("draws %zu of %zu faces (%s), near ones first in %zu clusters, ", plan.faces.size(),
                plan.soup_faces, plan.appearance.c_str(), plan.clusters.size());
  sentence += plan.site == ShadingSite::forward    ? "colour in one pass"
              : plan.site == ShadingSite::deferred ? "a visibility pass, then colour once a pixel"
                                                   : "no colours, an empty fragment shader";
  if (plan.color_mlp && plan.site != ShadingSite::nowhere) sentence += " by the color MLP";
  sentence += plan.reversed_depth ? "; reversed depth" : "; ordinary depth range";
  if (!plan.specialise) sentence += "; no specialisation, as requested";
  return sentence;
}

}  // namespace

std::string describe(const AppliedSpecialisation& applied) {
  return name_of(applied.what) + (": " + effect_of(applied)) + margin_of(applied);
}

std::vector<std::string> describe(const RenderPlan& plan) {
  std::vector<std::string> sentences{describe_frame(plan)};
  const auto add = [&](std::string sentence) { sentences.push_back(std::move(sentence)); };
  if (plan.quality.resolution_scale < 1)
    add("draws " + describe(plan.quality) + " and enlarges the image bilinearly");
  if (plan.quality.supersampling > 1) add("draws " + describe(plan.quality));
  if (plan.ignores_specialisations)
    add("--keep has no effect: the published pipeline has no specialisations");
  if (plan.undrawable_faces > 0)
    add(formatted("%zu faces without area or with corners that are not finite are not drawn",
                  plan.undrawable_faces));
  for (const AppliedSpecialisation& each : plan.applied) add(describe(each));
  if (plan.zero_weights > 0)
    add(formatted("%d weights of zero are not computed (exact)", plan.zero_weights));
  if (plan.lattice.refused_alpha_cell_bytes > 0)
    add(
        formatted("alpha is stored by the texel: by the cell it would take %.1f MB, which is more "
                  "than allowed",
                  double(plan.lattice.refused_alpha_cell_bytes) / 1e6));
  if (plan.requested_stage == ShadingStage::compute)
    add(plan.shading_stage == ShadingStage::compute
            ? "shading runs as compute, as requested"
            : "nothing is shaded as compute, as colours are written at once");
  return sentences;
}

}  // namespace tureen
