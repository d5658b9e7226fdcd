// The color MLP's part of a plan: the inputs and neurons that a scene does not need.
#include <algorithm>
#include <cmath>

#include "runtime/plan/lattice_traits.hpp"
#include "runtime/plan/plan_draft.hpp"
#include "runtime/plan/view_dependence.hpp"

namespace tureen {

namespace {

double largest_blend(const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!mlp.blend_channel) return 1.0;
  const FeatureRange& range = ranges[std::size_t(*mlp.blend_channel)];
  return std::max(std::abs(double(range.low)), std::abs(double(range.high)));
}

void plan_view_direction(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!draft.may(Specialisation::view_direction) || mlp.encoding == DirectionEncoding::none) return;
  const double moves = view_dependence(mlp) * largest_blend(mlp, ranges);
  if (!(moves <= double(half_step))) return;
  draft.plan.view_direction = false;
  draft.apply({.what = Specialisation::view_direction, .margin = steps_of(moves)});
}

/// Widens a range of a single value. The network's source then reads the feature instead of folding
/// the value into the bias.
void keep_reading(FeatureRange& range) {
  if (range.low == range.high) range.low = std::nextafter(range.low, -1.0f);
}

}  // namespace

void plan_network(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& measured) {
  SoupPlan& plan = draft.plan;
  plan.view_direction = mlp.encoding != DirectionEncoding::none;
  plan.latent_features = true;
  plan.feature_ranges = measured;
  plan_view_direction(draft, mlp, measured);
  if (!draft.may(Specialisation::weight_uniforms)) return;
  plan.mlp_weights =
      draft.may(Specialisation::dead_neurons) ? MlpWeights::constants : MlpWeights::all_constants;
  draft.apply({Specialisation::weight_uniforms});
  if (plan.mlp_weights == MlpWeights::all_constants) return;
  if (!draft.may(Specialisation::latent_features))
    for (std::size_t i = 4; i < plan.feature_ranges.size(); ++i)
      keep_reading(plan.feature_ranges[i]);
  const ColorMlpSource source = color_mlp_source(plan.view_direction ? mlp : without_direction(mlp),
                                                 plan.mlp_weights, plan.feature_ranges);
  plan.zero_weights = source.zero_weights;
  if (source.dead_neurons > 0)
    draft.apply({Specialisation::dead_neurons, std::size_t(source.dead_neurons),
                 std::size_t(source.hidden_neurons)});
  if (source.reads_features1 || !draft.may(Specialisation::latent_features)) return;
  plan.latent_features = false;
  draft.apply({Specialisation::latent_features});
}

}  // namespace tureen
