#include "jobs/bench/bench_cases.hpp"

#include <algorithm>
#include <exception>
#include <limits>

#include "base/error.hpp"
#include "base/steady_seconds.hpp"
#include "jobs/baseline/splat_baseline_order.hpp"
#include "jobs/bench/copy_ceiling.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer.hpp"
#include "runtime/splats/ordered_splats.hpp"

namespace tureen {

namespace {

constexpr const char* ours = "tureen";
constexpr const char* generic = "generic";
constexpr const char* by_raster = "raster";
constexpr const char* in_tiles = "tiles";
constexpr const char* in_fragments = "tureen-fragment";
constexpr const char* as_compute = "tureen-compute";
/// The name in result files. It equals that of earlier versions, so that --against can compare.
constexpr const char* baseline = "published";
constexpr const char* triangles = "triangles";
constexpr const char* copy = "copy";
const std::vector<std::string> all_names{ours,    in_fragments, as_compute, by_raster, in_tiles,
                                         generic, "baseline",   baseline,   triangles, copy};

double milliseconds_since(double start) { return 1000 * (steady_seconds() - start); }

/// Milliseconds a view for sorting all splats, by SplatOrder (also for tiles, which sort the same
/// keys) or by the baseline's order: the mean over the cameras of the best of three times. Empty
/// without splats. `clock` is in seconds; null: the steady clock.
std::optional<double> time_of_order(const Scene& scene, PipelineKind pipeline,
                                    std::span<const Camera> cameras,
                                    const std::function<double()>& clock) {
  struct Centers {
    std::vector<glm::vec3> centers;
    const glm::dmat4& world_from_layer;
  };
  std::vector<Centers> layers;
  for (const Layer& layer : scene.layers)
    if (const auto* splats = std::get_if<Splats>(&layer.primitives)) {
      Centers& of_layer = layers.emplace_back(Centers{{}, layer.world_from_layer});
      for (std::size_t i = 0; i < count(*splats); ++i)
        of_layer.centers.push_back(center(*splats, i));
    }
  if (layers.empty()) return std::nullopt;
  const auto now = [&] { return clock ? clock() : steady_seconds(); };
  SplatOrder order;
  SplatBaselineOrder baseline;
  double seconds = 0;
  for (const Camera& camera : cameras) {
    std::vector<FrameCamera> in_layers;
    std::vector<SplatsInView> views;
    for (const Centers& layer : layers) {
      in_layers.push_back(camera_in_layer(camera, layer.world_from_layer, {}));
      views.push_back(in_view(layer.centers, in_layers.back()));
    }
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double start = now();
      if (pipeline == PipelineKind::tureen)
        order.sort(views);
      else
        baseline.sort(layers.front().centers, in_layers.front());
      best = std::min(best, now() - start);
    }
    seconds += best;
  }
  return 1000 * seconds / double(cameras.size());
}

/// A renderer with one plan, as in `tureen render`.
class RendererCase final : public BenchCase {
 public:
  RendererCase(const std::string& name, const gl::Context& context, const Scene& scene,
               PipelineKind pipeline, const PlanPreferences& preferences)
      : context_(context), scene_(scene), pipeline_(pipeline) {
    configuration.name = name;
    const DeviceLimits limits = device_limits(context.capabilities());
    double start = steady_seconds();
    const std::vector<PlacedLayer> layers = placed_layers(scene);
    const bool is_baseline = pipeline == PipelineKind::baseline;
    RenderPlan plan = is_baseline ? make_baseline_plan(only_layer(scene).primitives, preferences)
                                  : make_plan(layers, limits, preferences);
    configuration.plan_ms = milliseconds_since(start);
    start = steady_seconds();
    PreparedScene prepared = is_baseline ? prepare_baseline(layers.front(), limits, std::move(plan))
                                         : prepare_scene(layers, limits, std::move(plan));
    const RenderOptions options{.background = glm::vec4(scene.info.background, 1.0f)};
    renderer_ = std::make_unique<Renderer>(context, std::move(prepared), options);
    renderer_->finish();
    configuration.upload_ms = milliseconds_since(start);
    configuration.plan = describe(renderer_->plan());
    configuration.specialisations = renderer_->plan().applied();
    configuration.device_mib = double(renderer_->device_bytes()) / bytes_per_mib;
  }
  void draw(const FrameInput& input) override { renderer_->draw(input); }
  void finish() const override { renderer_->finish(); }
  Image8 last_frame() const override { return renderer_->read_color(); }
  PassTimes passes(std::span<const Camera> cameras) override {
    // Enough repeats to make the rounding of timestamps negligible, in a short time.
    constexpr int repeats = 20;
    return time_passes(context_, *renderer_, cameras, repeats);
  }
  std::optional<double> order_ms(std::span<const Camera> cameras,
                                 const std::function<double()>& clock) const override {
    const bool sorts = renderer_->plan().quality.splat_order != Quality::SplatOrder::stochastic;
    if (!sorts) return std::nullopt;
    return time_of_order(scene_, pipeline_, cameras, clock);
  }
  bool blends_in_tiles() const override { return renderer_->plan().splats_in_tiles; }

 private:
  const gl::Context& context_;
  const Scene& scene_;
  PipelineKind pipeline_;
  std::unique_ptr<Renderer> renderer_;
};

class CopyCase final : public BenchCase {
 public:
  explicit CopyCase(const gl::Context& context) {
    configuration.name = copy;
    const double start = steady_seconds();
    copy_ = std::make_unique<CopyCeiling>(context);
    copy_->finish();
    configuration.upload_ms = milliseconds_since(start);
    configuration.plan = {
        "copies the same number of pixels with a full-screen triangle (upper limit of the speed)"};
  }
  void draw(const FrameInput& input) override {
    copy_->draw(input.camera.width, input.camera.height);
  }
  void finish() const override { copy_->finish(); }
  Image8 last_frame() const override { return copy_->read_copy(); }
  PassTimes passes(std::span<const Camera>) override {
    return {.ms = {}, .gap = PassTimesGap::one_pass, .reason = "a copy has one pass", .gpu_ms = {}};
  }

 private:
  std::unique_ptr<CopyCeiling> copy_;
};

std::vector<std::string> names_of(const BenchCaseOptions& options) {
  std::vector<std::string> names = options.only;
  std::replace(names.begin(), names.end(), std::string("baseline"), std::string(baseline));
  const PlanPreferences& plan = options.plan;
  if (names.empty()) {
    if (options.pipeline == PipelineKind::baseline)
      names = {baseline};
    else if (!plan.specialise)
      names = {generic};
    else
      names = {ours, generic, baseline};
  }
  if (options.ceilings)
    for (const char* ceiling : {triangles, copy})
      if (std::find(names.begin(), names.end(), ceiling) == names.end()) names.push_back(ceiling);
  return names;
}

/// Equivalent options of `tureen render`, and the preferences that they set.
struct Setting {
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan;
  std::vector<std::string> options;
};

Setting setting_of(const std::string& name, PlanPreferences plan) {
  if (name == baseline) {
    plan.shading_stage = ShadingStage::fragment;  // the baseline's only stage
    return {PipelineKind::baseline, plan, {"--pipeline", "baseline"}};
  }
  if (name == in_fragments) plan.shading_stage = ShadingStage::fragment;
  if (name == as_compute) plan.shading_stage = ShadingStage::compute;
  if (name == by_raster) plan.splat_blending = SplatBlending::raster;
  if (name == in_tiles) plan.splat_blending = SplatBlending::tiles;
  std::vector<std::string> options;
  if (plan.splat_blending == SplatBlending::raster) options = {"--blend", "raster"};
  if (plan.splat_blending == SplatBlending::tiles) options = {"--blend", "tiles"};
  if (plan.shading_stage == ShadingStage::compute)
    options.insert(options.end(), {"--shading", "compute"});
  else if (name == in_fragments)
    options.insert(options.end(), {"--shading", "fragment"});
  if (name == triangles) {
    plan.site = ShadingSite::nowhere;
    plan.shading_stage = ShadingStage::fragment;  // nothing is shaded
  }
  plan.specialise = name != generic;
  if (!plan.specialise) {
    options.emplace_back("--no-specialise");
    return {PipelineKind::tureen, plan, options};
  }
  std::string kept;
  for (const SpecialisationName& known : specialisation_names())
    if (!plan.specialisations.has(known.what))
      kept += (kept.empty() ? "" : ",") + std::string(known.name);
  if (!kept.empty()) options.insert(options.end(), {"--keep", kept});
  return {PipelineKind::tureen, plan, options};
}

std::unique_ptr<BenchCase> make_case(const std::string& name, const BenchCaseOptions& options,
                                     const gl::Context& context, const Scene& scene) {
  if (name == copy) return std::make_unique<CopyCase>(context);
  const bool has_splats = splat_count(scene) > 0;
  if (has_splats && (name == in_fragments || name == as_compute || name == triangles))
    throw UsageError("the case '" + name + "' is only of triangles; this scene has splats");
  if (!has_splats && (name == by_raster || name == in_tiles))
    throw UsageError("the case '" + name + "' is only of splats; this scene has triangles");
  const Setting setting = setting_of(name, options.plan);
  auto bench_case =
      std::make_unique<RendererCase>(name, context, scene, setting.pipeline, setting.plan);
  bench_case->configuration.options = setting.options;
  if (options.opaque) bench_case->configuration.options.emplace_back("--opaque");
  return bench_case;
}

}  // namespace

BenchmarkCase BenchCase::benchmark_case() {
  return {.name = configuration.name,
          .draw = [this](const FrameInput& input) { draw(input); },
          .finish = [this] { finish(); }};
}

std::span<const std::string> bench_case_names() { return all_names; }

BenchCases make_cases(const BenchCaseOptions& options, const gl::Context& context,
                      const Scene& scene) {
  BenchCases result;
  result.sort = splat_count(scene) > 0;
  std::exception_ptr first;
  std::vector<std::string> names = names_of(options);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = names[i];
    const auto skip = [&](const Error& error) {
      if (!options.only.empty()) throw;  // the case was requested by name
      if (!first) first = std::current_exception();
      result.skipped.push_back({name, error.reason()});
    };
    try {
      result.list.push_back(make_case(name, options, context, scene));
      // The other way to blend, for comparison.
      if (options.only.empty() && name == ours && result.list.back()->blends_in_tiles())
        names.insert(names.begin() + std::ptrdiff_t(i) + 1, by_raster);
    } catch (const UsageError& error) {
      skip(error);
    } catch (const DeviceLimitError& error) {
      skip(error);
    }
    if (result.list.size() == 1 && result.peak_mib == 0) result.peak_mib = peak_mib();
  }
  if (result.list.empty()) std::rethrow_exception(first);
  return result;
}

}  // namespace tureen
