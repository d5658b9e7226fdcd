// The lattice's part of a plan: the network and the levels, chosen from its texels.
#include <algorithm>
#include <cmath>

#include "runtime/plan/lattice_traits.hpp"
#include "runtime/plan/plan_draft.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

/// Whether the network is never blended in, up to half a step of the colour.
bool never_blends_in(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!mlp.blend_channel || !draft.may(Specialisation::color_mlp)) return false;
  const FeatureRange& range = ranges[std::size_t(*mlp.blend_channel)];
  const double moves = double(std::max(range.high, -range.low)) * base_from_network(ranges);
  if (!(moves <= double(half_step))) return false;
  draft.apply({.what = Specialisation::color_mlp, .margin = steps_of(moves)});
  return true;
}

/// Finds the affine faces, and removes their inner texels if that pays. `gain`: upper bound of the
/// error of the colour per error of the features.
void plan_affine_texels(PlanDraft& draft, const LatticeTexture& texture,
                        const LatticeTraits& traits, double gain) {
  SoupPlan& plan = draft.plan;
  const std::size_t count = plan.faces.size();
  std::vector<std::uint8_t> levels(count);
  std::size_t texels = 0, kept = 0, affine_faces = 0;
  double largest_error = 0;
  // Rounded up, because the error decides.
  const float largest_residual = std::nextafter(float(double(half_step) / gain), INFINITY);
  for (std::size_t i = 0; i < count; ++i) {
    const int level = int(texture.patches[plan.faces[i]].level);
    const auto residual = affine_residual(texture, plan.faces[i], largest_residual);
    const double error = gain * double(residual.value_or(0));
    const bool affine = residual && error <= double(half_step);
    levels[i] = affine ? std::uint8_t(0) : std::uint8_t(level);
    texels += lattice::texel_count(level);
    kept += lattice::texel_count(levels[i]);
    affine_faces += affine ? 1 : 0;
    if (affine) largest_error = std::max(largest_error, error);
  }
  const bool all_affine = affine_faces == count;
  // Faces of different levels need a table read a fragment. It pays if a quarter of the texels is
  // saved, or if the scene needs the table anyway.
  const bool one_level = traits.lowest_level == traits.highest_level;
  const bool worth_it = all_affine || !one_level || kept < texels - texels / 4;
  if (kept == texels || !worth_it || traits.shares_texels) return;
  plan.lattice.levels = std::move(levels);
  if (all_affine) plan.lattice.uniform_level = 0;
  draft.apply({Specialisation::affine_texels, affine_faces, count, steps_of(largest_error)});
}

}  // namespace

namespace {

/// Called after the levels are chosen. Counts shared cells once for each face.
void choose_alpha_storage(PlanDraft& draft, const LatticeTexture& texture) {
  SoupPlan& plan = draft.plan;
  if (plan.opaque_count == plan.faces.size() || plan.flat_colors) return;
  std::uint64_t cells = 0;
  for (std::size_t i = 0; i < plan.faces.size(); ++i)
    cells +=
        lattice::cell_count(plan.lattice.levels.empty() ? int(texture.patches[plan.faces[i]].level)
                                                        : int(plan.lattice.levels[i]));
  const std::uint64_t bytes = cells * std::uint64_t(texture.is_float() ? 16 : 4);
  if (bytes <= draft.preferences.max_alpha_cell_bytes) return;
  plan.lattice.alpha_by_cell = false;
  plan.lattice.refused_alpha_cell_bytes = bytes;
}

void plan_lattice(PlanDraft& draft, const LatticeTexture& texture) {
  SoupPlan& plan = draft.plan;
  plan.color_mlp = texture.mlp.has_value();
  if (!draft.preferences.specialise) {
    if (plan.color_mlp) plan_network(draft, *texture.mlp, {});
    return;
  }

  const LatticeTraits traits = measure(texture, plan.faces);
  if (plan.color_mlp && never_blends_in(draft, *texture.mlp, traits.ranges)) plan.color_mlp = false;
  if (plan.color_mlp) plan_network(draft, *texture.mlp, traits.ranges);
  if (plan.faces.empty()) return;

  const bool opaque = plan.opaque_count == plan.faces.size();
  if (!plan.color_mlp && traits.constant_faces == plan.faces.size() && opaque &&
      draft.may(Specialisation::constant_lattices)) {
    plan.flat_colors = true;
    draft.apply({Specialisation::constant_lattices, plan.faces.size(), plan.faces.size()});
    return;
  }
  if (draft.may(Specialisation::affine_texels))
    plan_affine_texels(draft, texture, traits,
                       plan.color_mlp ? color_gain(*texture.mlp, traits.ranges) : 1.0);
  const bool one_level = traits.lowest_level == traits.highest_level;
  if (plan.lattice.levels.empty() && one_level && !traits.shares_texels)
    plan.lattice.uniform_level = traits.highest_level;
}

}  // namespace

void plan_appearance(PlanDraft& draft, const LatticeTexture& texture) {
  plan_lattice(draft, texture);
  choose_alpha_storage(draft, texture);
}

}  // namespace tureen
