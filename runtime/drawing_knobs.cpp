#include "runtime/drawing_knobs.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "soup/error.hpp"

namespace tureen {

namespace {

using FeatureStorage = RenderPreset::FeatureStorage;

void say(RenderPlan& plan, const std::string& sentence) {
  plan.sentences.push_back("knob: " + sentence);
}

void obey_feature_storage(const RenderPreset& preset, const DeviceLimits& limits,
                          RenderPlan& plan) {
  if (preset.feature_storage == FeatureStorage::visibility) return;
  if (!plan.color_mlp) {
    say(plan, "no features are stored, as there is no network that reads them");
    return;
  }
  if (preset.feature_storage == FeatureStorage::rgba16f && !limits.half_float_targets) {
    say(plan,
        "this device cannot draw half floats: instead of features, which face a pixel shows is "
        "stored, which loses less");
    return;
  }
  plan.feature_storage = preset.feature_storage;
  // Eight channels of features leave no room to say that there is none.
  plan.depth_rejects_background = true;
  say(plan, preset.feature_storage == FeatureStorage::rgba16f
                ? "the features of the nearest fragment are stored as half floats"
                : "the features of the nearest fragment are stored as bytes, cut off at 0 and 1");
}

void obey_alpha_to_coverage(const RenderPreset& preset, const DeviceLimits& limits,
                            RenderPlan& plan) {
  if (preset.alpha_to_coverage == 0) return;
  const auto& counts = limits.sample_counts;
  if (counts.empty())
    throw DeviceLimitError("alpha to coverage needs multisampling, which this device has not");
  const auto enough = std::lower_bound(counts.begin(), counts.end(), preset.alpha_to_coverage);
  plan.coverage_samples = enough == counts.end() ? counts.back() : *enough;
  std::string sentence = "alpha to coverage of " + std::to_string(plan.coverage_samples) +
                         " samples a pixel instead of the alpha test";
  if (plan.coverage_samples != preset.alpha_to_coverage)
    sentence += "; " + std::to_string(preset.alpha_to_coverage) +
                " were asked for, which this device has not";
  say(plan, sentence);
}

void obey_resampling(const RenderPreset& preset, RenderPlan& plan) {
  plan.resolution_scale = preset.resolution_scale;
  plan.supersampling = preset.supersampling;
  if (plan.resolution_scale < 1) {
    char percent[16];
    std::snprintf(percent, sizeof percent, "%.4g", 100 * plan.resolution_scale);
    say(plan, std::string(percent) +
                  " % of the rows and columns are drawn, the picture is enlarged bilinearly");
  }
  const std::string n = std::to_string(plan.supersampling);
  if (plan.supersampling > 1) say(plan, "a pixel is the mean of " + n + " x " + n + " samples");
}

}  // namespace

std::optional<ShadingSite> wanted_site(const PlanPreferences& preferences) {
  std::optional<ShadingSite> site = preferences.site;
  if (!preferences.preset) return site;
  const RenderPreset& preset = *preferences.preset;
  if (!site && preset.site != RenderPreset::Site::automatic)
    site =
        preset.site == RenderPreset::Site::forward ? ShadingSite::forward : ShadingSite::deferred;
  if (preset.alpha_to_coverage > 0) {
    if (site == ShadingSite::deferred)
      throw UsageError("alpha to coverage shades every fragment at once: there is no shading pass");
    return site.value_or(ShadingSite::forward);
  }
  if (preset.feature_storage != FeatureStorage::visibility && site == ShadingSite::forward)
    throw UsageError("features are kept for a shading pass, and a forward plan has none");
  return site;
}

void obey_drawing_knobs(const RenderPreset& preset, const DeviceLimits& limits, RenderPlan& plan) {
  if (plan.pipeline == PipelineKind::published) {
    RenderPreset others = preset;
    others.resolution_scale = 1;
    others.supersampling = 1;
    if (!is_faithful(others))
      throw UsageError(
          "the published pipeline draws in one way: of a preset it obeys resolution "
          "scale and supersampling, not " +
          describe(others));
  } else {
    if (preset.site != RenderPreset::Site::automatic)
      say(plan, plan.site == ShadingSite::forward ? "every fragment is coloured at once"
                                                  : "colours are made once a pixel");
    obey_feature_storage(preset, limits, plan);
    obey_alpha_to_coverage(preset, limits, plan);
  }
  obey_resampling(preset, plan);
}

}  // namespace tureen
