#include "jobs/tradeoff/study.hpp"

#include <cassert>
#include <iterator>

#include "jobs/timing/benchmark.hpp"
#include "jobs/tradeoff/measurer.hpp"
#include "jobs/visibility/splat_use.hpp"
#include "jobs/visibility/visibility_count.hpp"
#include "splatting/layer.hpp"

namespace tureen::tradeoff {

namespace {

std::vector<Job> jobs_of(const std::vector<QualitySetting>& settings,
                         const std::vector<Configuration>& list, bool specialised) {
  std::vector<Job> jobs;
  for (const Configuration& configuration : list)
    jobs.push_back(job_of(settings, configuration, specialised));
  return jobs;
}

/// After the single changes: all combinations of the settings that matter, and the front.
void finish(const StudyOptions& options, const char* stage, Measurer& measurer, Panel& panel) {
  find_ranges(panel);
  measurer.measure(jobs_of(panel.settings, combinations_of(panel, options.max_combinations), true),
                   stage);
  find_front(panel);
  if (auto warning = spread_warning(panel.aa_spread)) panel.notes.push_back(*std::move(warning));
}

std::vector<ImageF> references_of(const StudyScene& scene, const StudyOptions& options,
                                  Samples samples, const char* stage) {
  return reference_images(scene.scene, scene.cameras,
                          {.samples = samples,
                           .subpixel_bits = options.subpixel_bits,
                           .background = options.background,
                           .progress = [&](double done) { options.report(stage, done); }});
}

RenderError ideal_error(const std::vector<ImageF>& reference, bool with_flip) {
  return error_between(reference, as_shown(reference), with_flip);
}

std::vector<QualitySetting> settings_of(const StudyScene& scene, const StudyOptions& options) {
  const Layer& layer = only_layer(scene.scene);
  const auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
  const auto progress = [&](double done) { options.report("visible primitives", done); };
  if (!soup) {
    const auto& splats = std::get<Splats>(layer.primitives);
    std::vector<std::uint64_t> weights;
    if (splatting::has_layer_for(splats))
      weights = splat_use(splats, layer.world_from_layer, scene.counting, progress).weights;
    return scene_settings(splats, weights);
  }
  return scene_settings(*soup, count_visible_pixels(scene.context, *soup, origin_of(layer),
                                                    scene.counting, progress));
}

void study_drawing(const StudyScene& scene, const StudyOptions& options, Study& study) {
  Panel& panel = study.drawing;
  const bool traced = options.samples == Samples::traced;
  References references{references_of(scene, options, Samples::device, "reference images"),
                        references_of(scene, options, traced ? Samples::traced : Samples::exact,
                                      "exact reference images")};
  study.grid = error_between(references.exact, references.judge, options.with_flip);
  if (traced || options.samples == Samples::exact) references.judge = references.exact;
  panel.ideal = ideal_error(references.judge, options.with_flip);

  panel.settings = settings_of(scene, options);
  const std::vector<Configuration> single = single_changes(panel.settings);

  Measurer measurer(scene, options, references, panel);
  std::vector<Job> jobs = jobs_of(panel.settings, single, true);
  // The baseline follows the defaults, so that both are in the same group.
  Job baseline = job_of(panel.settings, single.front(), true);
  baseline.outcome.name = "baseline";
  baseline.outcome.factor = Factor::baseline;
  baseline.plan = {};
  jobs.insert(jobs.begin() + 1, std::move(baseline));
  std::vector<Job> generic = jobs_of(panel.settings, single, false);
  std::move(generic.begin(), generic.end(), std::back_inserter(jobs));
  measurer.measure(std::move(jobs), "one setting at a time");
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i)
    if (panel.outcomes[i].factor == Factor::baseline) study.baseline = i;
  finish(options, "combined settings", measurer, panel);
}

void study_antialiasing(const StudyScene& scene, const StudyOptions& options, Study& study) {
  Panel& panel = study.antialiasing;
  const References references{
      references_of(scene, options, Samples::antialiased, "antialiased reference images"), {}};
  panel.ideal = ideal_error(references.judge, options.with_flip);
  panel.settings = antialiasing_settings(options.max_samples, splat_count(scene.scene) > 0);
  Measurer measurer(scene, options, references, panel);
  measurer.measure(jobs_of(panel.settings, single_changes(panel.settings), true), "antialiasing");
  finish(options, "combined antialiasing", measurer, panel);
}

}  // namespace

Study run_study(const StudyScene& scene, const StudyOptions& options) {
  assert(!scene.cameras.empty());
  Study study;
  study_drawing(scene, options, study);
  study_antialiasing(scene, options, study);
  return study;
}

}  // namespace tureen::tradeoff
