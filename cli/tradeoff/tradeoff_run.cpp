#include "cli/tradeoff/tradeoff_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "camera/camera_sets.hpp"
#include "camera/navigation.hpp"
#include "cli/measuring/bench_device.hpp"
#include "cli/measuring/bench_views.hpp"
#include "cli/options/values.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/version.hpp"
#include "jobs/tradeoff/model_errors.hpp"
#include "jobs/tradeoff/study.hpp"

namespace tureen::cli {

namespace {

struct TradeoffViews {
  std::string camera_set;      // in the report: "scene:4", "hemisphere:8,adversarial"
  std::vector<Camera> judges;  // at least one
  /// The triangle budget counts visible faces in these views. If it counted in the views of the
  /// judges, removing faces that no judge sees would seem to cause no error.
  std::vector<Camera> counting;
  std::vector<std::string> notes;  // on missing data in camera files
};

struct DefaultViews {
  int count = 4;
  bool adversarial = false;  // also the 4 adversarial views
};

/// `count` of the scene's cameras at another size, evenly spaced. The first is half a step after
/// the scene's first camera, so that another `count` selects other cameras.
std::vector<Camera> own_cameras(const Scene& scene, std::size_t count, const Lens& lens) {
  const std::size_t all = scene.cameras.size(), taken = std::min(count, all);
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < taken; ++i)
    cameras.push_back(
        resized(scene.cameras[(2 * i + 1) * all / (2 * taken)], lens.width, lens.height));
  return cameras;
}

bool is_among(const Camera& camera, const std::vector<Camera>& cameras) {
  return std::any_of(cameras.begin(), cameras.end(), [&](const Camera& other) {
    return other.view_from_world == camera.view_from_world;
  });
}

/// Views from a hemisphere and from the scene's cameras, except the views of the judges.
std::vector<Camera> counting_views(const Scene& scene, const Lens& lens,
                                   const std::vector<Camera>& judges) {
  // Enough views to see every face that is large in some view; few enough to draw in seconds.
  constexpr int each = 64;
  std::vector<Camera> views = hemisphere(subject_of(scene), each, lens);
  const std::vector<Camera> own = own_cameras(scene, each, lens);
  views.insert(views.end(), own.begin(), own.end());
  std::erase_if(views, [&](const Camera& view) { return is_among(view, judges); });
  return views;
}

/// The sets of `options` at its single size. Without sets, `defaults.count` of the scene's cameras,
/// evenly spaced in their order, or views from a hemisphere if it has no cameras. Throws the
/// exceptions of bench_views().
TradeoffViews tradeoff_views(const BenchViewOptions& options, const DefaultViews& defaults,
                             const Scene& scene, const std::string& scene_path) {
  const ImageSize size = parse_size(options.sizes.front());
  const Lens lens{.width = size.width, .height = size.height};
  TradeoffViews views;
  BenchViewOptions sets = options;
  if (sets.cameras.empty()) {
    if (scene.cameras.empty()) {
      sets.cameras.push_back(fmt::format("hemisphere:{}", defaults.count));
    } else {
      views.judges = own_cameras(scene, std::size_t(defaults.count), lens);
      views.camera_set = fmt::format("scene:{}", views.judges.size());
    }
    if (defaults.adversarial) sets.cameras.push_back("adversarial");
  }
  if (!sets.cameras.empty()) {
    BenchViewList list = bench_views(sets, scene, scene_path);
    views.notes = std::move(list.notes);
    for (const BenchViews& each : list.views) {
      views.camera_set += (views.camera_set.empty() ? "" : ",") + each.camera_set;
      views.judges.insert(views.judges.end(), each.cameras.begin(), each.cameras.end());
    }
  }
  views.counting = counting_views(scene, lens, views.judges);
  return views;
}

/// The defaults of an effort.
struct Defaults {
  std::string size;
  DefaultViews views;
  int rounds;
  int combinations;
  int samples;      // per axis
  int photographs;  // 0: all
};

Defaults defaults_of(Effort effort) {
  switch (effort) {
    case Effort::quick:
      return {"96x64", {.count = 2}, 1, 4, 2, 2};
    case Effort::normal:
      return {"480x270", {.count = 4}, 3, 48, 4, 8};
    case Effort::full:
      return {"1280x720", {.count = 8, .adversarial = true}, 5, 256, 8, 0};
  }
  return {};
}

BenchViewOptions view_options(const TradeoffOptions& options) {
  BenchViewOptions views;
  views.cameras = options.cameras;
  if (std::count(views.cameras.begin(), views.cameras.end(), "dataset") > 0)
    views.dataset = options.dataset.path;
  views.sizes = {options.size.empty() ? defaults_of(options.effort).size : options.size};
  return views;
}

/// The photographs for E_model; empty without a dataset. They are read before anything is measured,
/// so that an error does not cost minutes of work.
std::vector<Photograph> test_photographs(const TradeoffOptions& options, TradeoffReport& report) {
  if (options.dataset.path.empty()) return {};
  const int most =
      options.photographs > 0 ? options.photographs : defaults_of(options.effort).photographs;
  Dataset dataset = read(options.dataset, DatasetPart::test);
  std::vector<Photograph> photographs =
      tradeoff::spread_out(std::move(dataset.test), std::size_t(most));
  if (photographs.empty())
    throw InputError({options.dataset.path}, "the dataset has no test photographs");
  for (std::string& note : notes_of(dataset.remarks)) report.notes.push_back(std::move(note));
  return photographs;
}

void measure_models(const TradeoffOptions& options, const Scene& scene,
                    const std::vector<Photograph>& photographs, TradeoffReport& report) {
  if (photographs.empty()) return;
  report.model = {options.dataset.path, "test", int(photographs.size()), name(SsimBorder::valid)};
  Progress progress("photographs");
  tradeoff::ModelOptions model{.backend = options.backend,
                               .background = scene.info.background,
                               .with_flip = options.with_flip};
  model.progress = [&](double fraction) { progress.update(0.8 * fraction); };
  tradeoff::add_model_errors(report.study.drawing, scene, photographs, model);
  model.progress = [&](double fraction) { progress.update(0.8 + 0.2 * fraction); };
  tradeoff::add_model_errors(report.study.antialiasing, scene, photographs, model);
}

/// The part of the report that is known before the measurements.
TradeoffReport head_of(const TradeoffOptions& options, const Scene& scene) {
  TradeoffReport report;
  report.notes = notes_of(scene.info);
  if (scene.quality != Quality{})
    report.notes.push_back("measured with the default quality settings instead of the scene's: " +
                           describe(scene.quality));
  report.date = utc_now();
  report.program = {program_version(), program_commit(), options.arguments};
  const Primitives& primitives = only_layer(scene).primitives;
  const auto* soup = std::get_if<TriangleSoup>(&primitives);
  report.scene = {
      scene.info.name, options.scene.path, triangle_count(scene),
      soup ? appearance_name(soup->appearance) : tureen::describe(std::get<Splats>(primitives)),
      splat_count(scene)};
  report.machine = this_machine();
  report.with_flip = options.with_flip;
  report.samples = options.samples == tradeoff::Samples::device  ? "device"
                   : options.samples == tradeoff::Samples::exact ? "exact"
                                                                 : "trace";
  report.limits = options.limits;
  return report;
}

tradeoff::Study study_of(const TradeoffOptions& options, const Scene& scene,
                         TradeoffReport& report) {
  const Defaults defaults = defaults_of(options.effort);
  report.rounds = options.rounds > 0 ? options.rounds : defaults.rounds;
  DefaultViews default_views = defaults.views;
  if (splat_count(scene) > 0) default_views.adversarial = false;  // those are of triangles
  const TradeoffViews views =
      tradeoff_views(view_options(options), default_views, scene, options.scene.path);
  report.notes.insert(report.notes.end(), views.notes.begin(), views.notes.end());
  report.camera_set = views.camera_set;
  report.views = int(views.judges.size());
  report.width = views.judges.front().width;
  report.height = views.judges.front().height;

  const gl::Context context = gl::Context::create({.backend = options.backend});
  report.device = device_of(context);
  const BenchClock clock = clock_for(report.device, options.processor_time);
  report.clock = clock.text;
  report.processor_time = options.processor_time;
  tradeoff::StudyOptions study{.subpixel_bits = tradeoff::device_subpixel_bits()};
  if (study.subpixel_bits != 8)
    report.notes.push_back(fmt::format(
        "this device rounds vertices to 1/{} pixel, and so does the oracle at its sample points; "
        "E_render differs on devices with the usual 1/256",
        1 << study.subpixel_bits));
  study.clock = clock.now;
  study.background = scene.info.background;
  study.samples = options.samples;
  study.rounds = report.rounds;
  study.max_combinations =
      std::size_t(options.combinations >= 0 ? options.combinations : defaults.combinations);
  study.max_samples = defaults.samples;
  study.with_flip = options.with_flip;
  std::optional<Progress> progress;
  std::string stage;
  study.progress = [&](const char* now, double fraction) {
    if (now != stage) {
      progress.reset();
      progress.emplace(now);
      stage = now;
    }
    progress->update(fraction);
  };
  tradeoff::Study found =
      tradeoff::run_study({context, scene, views.judges, views.counting}, study);
  progress.reset();
  const tradeoff::Candidates left = tradeoff::candidates(found.drawing);
  if (const auto cheapest = tradeoff::cheapest_within(left.points, report.limits))
    found.choice = left.index[*cheapest];
  return found;
}

}  // namespace

void check(const TradeoffOptions& options) { check(view_options(options)); }

TradeoffReport measure_tradeoff(const TradeoffOptions& options, const Scene& scene) {
  TradeoffReport report = head_of(options, scene);
  const std::vector<Photograph> photographs = test_photographs(options, report);
  report.study = study_of(options, scene, report);
  measure_models(options, scene, photographs, report);
  return report;
}

}  // namespace tureen::cli
