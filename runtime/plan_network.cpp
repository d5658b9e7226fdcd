// The color MLP's part of a plan: which of its inputs and neurons a scene can do without.
#include <algorithm>
#include <cmath>

#include "runtime/lattice_traits.hpp"
#include "runtime/plan_draft.hpp"
#include "runtime/view_dependence.hpp"

namespace tureen {

namespace {

double largest_blend(const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!mlp.blend_channel) return 1.0;
  const FeatureRange& range = ranges[std::size_t(*mlp.blend_channel)];
  return std::max(std::abs(double(range.low)), std::abs(double(range.high)));
}

void leave_out_view_direction(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& ranges) {
  if (!draft.may(LeaveOut::view_direction) || mlp.encoding == DirectionEncoding::none) return;
  const double moves = view_dependence(mlp) * largest_blend(mlp, ranges);
  if (moves > double(half_step)) return;
  draft.plan.view_direction = false;
  draft.leave_out(LeaveOut::view_direction,
                  formatted("the view direction, it moves no colour by more than %.5f (1/510 = "
                            "0.00196 allowed)",
                            moves));
}

/// A range that is a single value makes the network's source use that value: widened where the
/// caller wants to keep what that would leave out.
void keep_reading(FeatureRange& range) {
  if (range.low == range.high) range.low = std::nextafter(range.low, -1.0f);
}

/// Where the network takes over altogether, the base colour need not be blended in. The blend
/// channel r then counts as 1 in the network's inputs, too: mlp(r) + (1 - r) (base - mlp(r))
/// becomes mlp(1), which moves a colour by what |1 - r| moves the network and by |1 - r| of how far
/// base and network, which is in [0, 1], lie apart.
void leave_out_base_color(PlanDraft& draft, const ColorMlp& mlp, FeatureRanges& ranges) {
  if (!mlp.blend_channel) return;
  const int channel = *mlp.blend_channel;
  FeatureRange& range = ranges[std::size_t(channel)];
  const double from_one = std::max(std::abs(1.0 - range.low), std::abs(1.0 - range.high));
  const double moves =
      from_one * (base_from_network(ranges) + network_gain(mlp, channel, channel + 1));
  if (!(moves <= double(half_step)) || !draft.may(LeaveOut::base_color)) return keep_reading(range);
  draft.leave_out(
      LeaveOut::base_color,
      formatted("blending with the base colour, the blend channel lies within %.5f of "
                "1 and that moves no colour by more than %.5f (1/510 = 0.00196 allowed)",
                from_one, moves));
  range = {1.0f, 1.0f};
}

}  // namespace

void plan_network(PlanDraft& draft, const ColorMlp& mlp, const FeatureRanges& measured) {
  RenderPlan& plan = draft.plan;
  plan.view_direction = mlp.encoding != DirectionEncoding::none;
  plan.latent_features = true;
  plan.feature_ranges = measured;
  leave_out_view_direction(draft, mlp, measured);
  if (!draft.may(LeaveOut::weight_uniforms)) return;
  plan.mlp_weights =
      draft.may(LeaveOut::dead_neurons) ? MlpWeights::constants : MlpWeights::all_constants;
  draft.leave_out(LeaveOut::weight_uniforms,
                  "uniforms, the network's weights are compiled in as constants");
  if (plan.mlp_weights == MlpWeights::all_constants) return;
  leave_out_base_color(draft, mlp, plan.feature_ranges);
  if (!draft.may(LeaveOut::latent_features))
    for (std::size_t i = 4; i < plan.feature_ranges.size(); ++i)
      keep_reading(plan.feature_ranges[i]);
  const ColorMlpSource source = color_mlp_source(plan.view_direction ? mlp : without_direction(mlp),
                                                 plan.mlp_weights, plan.feature_ranges);
  if (source.dead_neurons + source.zero_weights > 0)
    draft.leave_out(
        LeaveOut::dead_neurons,
        formatted("%d of %d hidden neurons that never fire and %d weights of zero (exact)",
                  source.dead_neurons, source.hidden_neurons, source.zero_weights));
  if (source.reads_features1 || !draft.may(LeaveOut::latent_features)) return;
  plan.latent_features = false;
  draft.leave_out(LeaveOut::latent_features,
                  "features 4 and above, each is the same everywhere or has no weight (exact)");
}

}  // namespace tureen
