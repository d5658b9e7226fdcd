#include "runtime/render_options.hpp"

#include <utility>

#include "soup/preset_data.hpp"

namespace tureen {

namespace {

std::optional<PresetSoup> turn_knobs(const TriangleSoup& soup, const RenderOptions& options) {
  const std::optional<RenderPreset>& preset = options.plan.preset;
  if (!preset || options.plan.pipeline == PipelineKind::published || defect(*preset, soup))
    return std::nullopt;  // make_plan refuses what makes no sense
  return with_preset(soup, *preset, options.progress);
}

}  // namespace

PlannedSoup plan_soup(const TriangleSoup& soup, const DeviceLimits& device,
                      const RenderOptions& options) {
  std::optional<PresetSoup> turned = turn_knobs(soup, options);
  PlannedSoup planned;
  planned.plan =
      make_plan(turned ? turned->soup : soup, options.limits.value_or(device), options.plan);
  if (turned) {
    auto& sentences = planned.plan.sentences;
    sentences.insert(sentences.begin() + 1, turned->sentences.begin(), turned->sentences.end());
    planned.turned = std::make_shared<const TriangleSoup>(std::move(turned->soup));
  }
  return planned;
}

}  // namespace tureen
