#include "runtime/plan/plan_description.hpp"

#include <algorithm>
#include <cassert>

#include "base/decimal_text.hpp"

namespace tureen {

namespace {

/// "3 of 40 ".
std::string part_of(std::size_t count, std::size_t total) {
  return std::to_string(count) + " of " + std::to_string(total) + " ";
}

std::string margin_of(const AppliedSpecialisation& applied) {
  if (applied.margin > 0)
    return " (changes colours by at most " + fixed_decimal(applied.margin, 3) +
           " of an 8-bit step)";
  return applied.what == Specialisation::shading_pass ? " (exact up to rounding)" : " (exact)";
}

/// The effect of a specialisation in English.
std::string effect_of(const AppliedSpecialisation& applied) {
  const auto counted = [&](const char* what) {
    return part_of(applied.count, applied.total) + what;
  };
  switch (applied.what) {
    case Specialisation::alpha_test:
      return counted("faces are opaque throughout and need no alpha test");
    case Specialisation::transparent_faces:
      return counted("faces are transparent throughout and not drawn");
    case Specialisation::coincident_faces:
      return counted("faces lie behind an opaque one with the same corners and are not drawn");
    case Specialisation::small_triangles:
      return "faces that cover no pixel's centre are found in each frame and not drawn";
    case Specialisation::shading_pass:
      return "colours are written in the only pass, because they cost little";
    case Specialisation::background:
      return "the depth test rejects background pixels before shading";
    case Specialisation::interpolation:
      return "the three vertex colours of every face are equal and not interpolated";
    case Specialisation::harmonics_bands:
      return counted("harmonics bands are not evaluated");
    case Specialisation::color_mlp:
      return "the color MLP is never blended in and not evaluated";
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
    case Specialisation::transparent_splats:
      return counted("splats never reach the smallest blended alpha and are not drawn");
    case Specialisation::hidden_splats:
      return "splats behind closed pixels are found in each frame and not drawn";
  }
  assert(!"a specialisation without a description");
  return {};
}

std::string describe_frame(const SoupPlan& plan, const RenderPlan& common) {
  std::string sentence = "draws " + part_of(plan.faces.size(), plan.soup_faces) + "faces (" +
                         plan.appearance + "), near ones first in " +
                         std::to_string(plan.clusters.size()) + " clusters, ";
  sentence += plan.site == ShadingSite::forward    ? "colour in one pass"
              : plan.site == ShadingSite::deferred ? "a visibility pass, then colour once a pixel"
                                                   : "no colours, an empty fragment shader";
  if (plan.color_mlp && plan.site != ShadingSite::nowhere) sentence += " by the color MLP";
  sentence += common.reversed_depth ? "; reversed depth" : "; ordinary depth range";
  if (!common.specialise) sentence += "; no specialisation, as requested";
  return sentence;
}

template <class Add>
void add_splats(const SplatPlan& plan, Quality::SplatOrder order, const Add& add) {
  add("draws " + part_of(plan.drawn.size(), plan.splats) + "splats (" + plan.kernel + "), " +
      (order == Quality::SplatOrder::stochastic ? "each opaque with the probability of its alpha"
       : order == Quality::SplatOrder::exact    ? "blended from near to far along each ray"
                                                : "blended from near to far"));
  for (const AppliedSpecialisation& each : plan.applied) add(describe(each));
}

}  // namespace

std::string describe(const AppliedSpecialisation& applied) {
  return name_of(applied.what) + (": " + effect_of(applied)) + margin_of(applied);
}

std::vector<std::string> describe_sampling(const Quality& quality) {
  std::vector<std::string> sentences;
  Quality sampling = quality;
  sampling.splat_order = Quality::SplatOrder::center;
  if (quality.resolution_scale < 1)
    sentences.push_back("draws " + describe(sampling) + " and enlarges the image bilinearly");
  if (quality.supersampling > 1) sentences.push_back("draws " + describe(sampling));
  return sentences;
}

std::vector<std::string> describe(const RenderPlan& common) {
  if (!common.description.empty()) return common.description;
  std::vector<std::string> sentences;
  const bool several = common.layers.size() > 1;
  std::size_t layer = 0;
  const auto add = [&](const std::string& sentence) {
    sentences.push_back(several ? "layer " + std::to_string(layer) + ": " + sentence : sentence);
  };
  for (const std::shared_ptr<LayerPlan>& of_layer : common.layers) {
    ++layer;
    if (const auto* splats = std::get_if<SplatPlan>(of_layer.get())) {
      add_splats(*splats, common.quality.splat_order, add);
      continue;
    }
    const auto& plan = std::get<SoupPlan>(*of_layer);
    add(describe_frame(plan, common));
    if (layer == 1)
      for (std::string& sentence : describe_sampling(common.quality))
        sentences.push_back(std::move(sentence));
    if (plan.undrawable_faces > 0)
      add(std::to_string(plan.undrawable_faces) +
          " faces without area or with corners that are not finite are not drawn");
    for (const AppliedSpecialisation& each : plan.applied) add(describe(each));
    if (plan.zero_weights > 0)
      add(std::to_string(plan.zero_weights) + " weights of zero are not computed (exact)");
    if (plan.lattice.refused_alpha_cell_bytes > 0)
      add("alpha is stored by texel: by cell it would need " +
          fixed_decimal(double(plan.lattice.refused_alpha_cell_bytes) / 1e6, 1) +
          " MB, which is more than allowed");
    if (common.requested_stage == ShadingStage::compute)
      add(plan.shading_stage == ShadingStage::compute ? "shading runs as compute, as requested"
          : several ? "shading does not run as compute: there are several layers"
                    : "shading does not run as compute: colours are written in the only pass");
  }
  return sentences;
}

}  // namespace tureen
