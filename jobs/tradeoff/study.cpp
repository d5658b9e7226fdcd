#include "jobs/tradeoff/study.hpp"

#include <fmt/format.h>

#include <cassert>
#include <iterator>

#include "jobs/timing/benchmark.hpp"
#include "jobs/tradeoff/measurer.hpp"
#include "jobs/tradeoff/study_images.hpp"
#include "jobs/visibility/splat_use.hpp"
#include "jobs/visibility/visibility_count.hpp"
#include "splatting/layer.hpp"

namespace tureen::tradeoff {

namespace {

/// Rejects configurations that cannot be drawn, before any upload.
Refusal refusal_of(const std::vector<QualitySetting>& settings) {
  return [&settings](const Configuration& configuration) {
    return defect(applied_by(settings, configuration).quality);
  };
}

std::vector<Job> jobs_of(const std::vector<QualitySetting>& settings,
                         const std::vector<Configuration>& list, bool specialised) {
  std::vector<Job> jobs;
  for (const Configuration& configuration : list)
    jobs.push_back(job_of(settings, configuration, specialised));
  return jobs;
}

void add_skipped(Panel& panel, const Design& design) {
  for (const Skipped& skipped : design.skipped)
    panel.skipped.push_back({describe(panel.settings, skipped.configuration), skipped.reason});
}

/// The ranges of the settings, from the specialised outcomes of the star.
void find_ranges(Panel& panel) {
  std::vector<Configuration> configurations;
  std::vector<Measured> measured;
  for (const Outcome& outcome : panel.outcomes) {
    if (outcome.factor == Factor::generic || outcome.factor == Factor::baseline) continue;
    configurations.push_back(outcome.configuration);
    measured.push_back(
        {outcome.ms.min_of_medians, is_judged(outcome) ? outcome.error.psnr_db : std::nan("")});
  }
  panel.ranges = setting_ranges(configurations, measured, panel.settings.size());
}

/// After the star: all combinations of the settings that matter, and the front.
void finish(const StudyOptions& options, StudyStage stage, Measurer& measurer, Panel& panel) {
  find_ranges(panel);
  const Design rest = factorial(value_counts(panel.settings), panel.ranges,
                                refusal_of(panel.settings), options.factorial);
  add_skipped(panel, rest);
  panel.notes = describe(rest.reduction, options.factorial);
  measurer.measure(jobs_of(panel.settings, rest.configurations, true), stage);
  find_front(panel);
  if (auto warning = spread_warning(panel.aa_spread)) panel.notes.push_back(*std::move(warning));
}

RenderError ideal_error(const std::vector<ImageF>& reference, bool with_flip) {
  return error_between(reference, as_shown(reference), with_flip);
}

std::vector<QualitySetting> settings_of(const StudyScene& scene, const StudyOptions& options) {
  const Layer& layer = only_layer(scene.scene);
  const auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
  if (!soup) {
    const auto& splats = std::get<Splats>(layer.primitives);
    std::vector<std::uint64_t> weights;
    if (splatting::has_layer_for(splats))
      weights = splat_use(splats, layer.world_from_layer, scene.counting, [&](double fraction) {
                  report(options, StudyStage::visibility, fraction);
                }).weights;
    return drawing_settings(splats, weights);
  }
  const std::vector<std::uint64_t> visible = count_visible_pixels(
      scene.context, *soup, origin_of(layer), scene.counting,
      [&](double fraction) { report(options, StudyStage::visibility, fraction); });
  return drawing_settings(*soup, visible);
}

void study_drawing(const StudyScene& scene, const StudyOptions& options, Study& study) {
  Panel& panel = study.drawing;
  const bool traced = options.samples == Samples::traced;
  References references{
      oracle_images(scene, options, Samples::device, StudyStage::device_references),
      oracle_images(scene, options, traced ? Samples::traced : Samples::exact,
                    StudyStage::exact_references)};
  study.grid = error_between(references.exact, references.judge, options.with_flip);
  if (traced || options.samples == Samples::exact) references.judge = references.exact;
  panel.ideal = ideal_error(references.judge, options.with_flip);

  panel.settings = settings_of(scene, options);
  const Design star = tradeoff::star(value_counts(panel.settings), refusal_of(panel.settings));
  add_skipped(panel, star);

  Measurer measurer(scene, options, references, panel);
  std::vector<Job> jobs = jobs_of(panel.settings, star.configurations, true);
  // The baseline follows the defaults, so that both are in the same group.
  Job baseline = job_of(panel.settings, star.configurations.front(), true);
  baseline.outcome.name = "baseline";
  baseline.outcome.factor = Factor::baseline;
  baseline.plan = {};
  jobs.insert(jobs.begin() + 1, std::move(baseline));
  std::vector<Job> generic = jobs_of(panel.settings, star.configurations, false);
  std::move(generic.begin(), generic.end(), std::back_inserter(jobs));
  measurer.measure(std::move(jobs), StudyStage::settings);
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i)
    if (panel.outcomes[i].factor == Factor::baseline) study.baseline = i;
  finish(options, StudyStage::combined_settings, measurer, panel);
}

void study_antialiasing(const StudyScene& scene, const StudyOptions& options, Study& study) {
  Panel& panel = study.antialiasing;
  const References references{
      oracle_images(scene, options, Samples::antialiased, StudyStage::antialiased_references), {}};
  panel.ideal = ideal_error(references.judge, options.with_flip);
  panel.settings = antialiasing_settings(options.max_samples, splat_count(scene.scene) > 0);
  const Design star = tradeoff::star(value_counts(panel.settings), refusal_of(panel.settings));
  add_skipped(panel, star);
  Measurer measurer(scene, options, references, panel);
  measurer.measure(jobs_of(panel.settings, star.configurations, true), StudyStage::antialiasing);
  finish(options, StudyStage::combined_antialiasing, measurer, panel);
}

}  // namespace

const char* name_of(StudyStage stage) {
  constexpr const char* names[] = {"reference images",   "exact reference images",
                                   "visible primitives", "one setting at a time",
                                   "combined settings",  "antialiased reference images",
                                   "antialiasing",       "combined antialiasing"};
  return names[std::size_t(stage)];
}

Study run_study(const StudyScene& scene, const StudyOptions& options) {
  assert(!scene.cameras.empty());
  Study study;
  study_drawing(scene, options, study);
  study_antialiasing(scene, options, study);
  return study;
}

}  // namespace tureen::tradeoff
