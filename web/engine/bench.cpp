// The commands of bench.html: several scenes, and frames timed by the protocol of `tureen bench`
// (jobs/timing/benchmark.hpp), a few samples at a time.
#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/steady_seconds.hpp"
#include "camera/camera_sets.hpp"
#include "formats/scene_file.hpp"
#include "jobs/baseline/baseline.hpp"
#include "jobs/timing/benchmark.hpp"
#include "runtime/plan/plan_description.hpp"
#include "web/engine/scene_path.hpp"
#include "web/engine/unpacking.hpp"

namespace tureen::web {

namespace {

double milliseconds() { return 1e3 * steady_seconds(); }

struct BenchScene {
  Renderer tureen;
  std::optional<Renderer> published;
  Subject subject;
  std::vector<Camera> recorded;
  std::vector<Camera> cameras;  // for the next run
};

/// A case of a run: one scene, or several scenes in one frame.
struct BenchCase {
  struct Part {
    Renderer* renderer;
    const BenchScene* scene;
  };
  std::string name;
  std::vector<Part> parts;
};

}  // namespace

struct Bench {
  std::vector<std::unique_ptr<BenchScene>> scenes;
  std::vector<BenchCase> cases;
  std::optional<BenchmarkRun> run;
};

namespace {

Bench& bench_of(Engine& engine) {
  if (!engine.bench) engine.bench = std::make_shared<Bench>();
  return *engine.bench;
}

BenchScene& scene_at(Engine& engine, const Json& index) {
  if (index.get<std::size_t>() >= bench_of(engine).scenes.size())
    throw UsageError("there is no scene " + index.dump());
  return *bench_of(engine).scenes[index.get<std::size_t>()];
}

Json facts(const Renderer& renderer, double start) {
  renderer.finish();
  Json specialisations = Json::array();
  for (const AppliedSpecialisation& each : renderer.plan().applied())
    specialisations.push_back(object({{"name", name_of(each.what)},
                                      {"count", each.count},
                                      {"total", each.total},
                                      {"margin", each.margin}}));
  return object({{"plan", describe(renderer.plan())},
                 {"specialisations", specialisations},
                 {"device_bytes", renderer.device_bytes()},
                 {"upload_ms", milliseconds() - start}});
}

void clear(Engine& engine, const Json&) {
  engine.arriving.reset();
  engine.bench.reset();
}

/// {"scene": result of "read"}
Json add_scene(Engine& engine, const Json& arguments) {
  const Json& scene = arguments.at("scene");
  const double start = milliseconds();
  Renderer renderer(engine.page().context(), unpacked(engine));
  renderer.set_background(glm::vec4(vector_of(scene.at("background")), 1.0f));
  const Json result = facts(renderer, start);
  auto added = std::make_unique<BenchScene>(
      BenchScene{std::move(renderer), {}, subject_of(scene.at("subject")), {}, {}});
  for (const Json& camera : scene.at("cameras")) added->recorded.push_back(camera_of(camera));
  bench_of(engine).scenes.push_back(std::move(added));
  return result;
}

/// {"scene", "folder", "paths"}: adds the baseline for the same scene.
Json add_published(Engine& engine, const Json& arguments) {
  BenchScene& to = scene_at(engine, arguments.at("scene"));
  Scene scene = read_scene(scene_path(arguments));
  RenderOptions options{.background = glm::vec4(scene.info.background, 1.0f)};
  options.plan.quality = scene.quality;
  make_opaque(scene);
  const TriangleSoup& soup = only_soup(scene);
  const double start = milliseconds();
  RenderPlan plan = make_baseline_plan(soup, options.plan);
  const double planned = milliseconds();
  const DeviceLimits limits = device_limits(engine.page().capabilities());
  to.published.emplace(engine.page().context(),
                       prepare_baseline(placed_layers(scene).front(), limits, std::move(plan)),
                       options);
  Json result = facts(*to.published, planned);
  result["plan_ms"] = planned - start;
  return result;
}

/// {"scene", "width", "height", "set"}
void set_cameras(Engine& engine, const Json& arguments) {
  BenchScene& scene = scene_at(engine, arguments.at("scene"));
  const Lens lens{.width = arguments.at("width"), .height = arguments.at("height")};
  const auto text = arguments.at("set").get<std::string>();
  const auto set = parse_camera_set(text, {"hemisphere", "orbit", "recorded"});
  if (!set)
    throw UsageError("'" + text + "' is not a camera set: use hemisphere:N, orbit:N or recorded:N");
  if (set->kind == "hemisphere") {
    scene.cameras = hemisphere(scene.subject, set->count, lens);
  } else if (set->kind == "orbit") {
    scene.cameras =
        orbit(scene.subject, set->count, {three_quarter_view.azimuth, orbit_elevation}, lens);
  } else {
    if (scene.recorded.empty()) throw UsageError("the scene has no recorded cameras");
    scene.cameras = scene.recorded;
    if (scene.cameras.size() > std::size_t(set->count))
      scene.cameras.resize(std::size_t(set->count));
    for (Camera& camera : scene.cameras) camera = resized(camera, lens.width, lens.height);
  }
}

// -- runs ---------------------------------------------------------------------------------------

BenchCase bench_case_of(Engine& engine, const Json& benchmark_case) {
  BenchCase result{.name = benchmark_case.at("name").get<std::string>(), .parts = {}};
  if (const auto grid = benchmark_case.find("grid"); grid != benchmark_case.end()) {
    for (const Json& index : *grid)
      result.parts.push_back({&scene_at(engine, index).tureen, &scene_at(engine, index)});
    return result;
  }
  BenchScene& scene = scene_at(engine, benchmark_case.at("scene"));
  const bool published = benchmark_case.at("published").get<bool>();
  if (published && !scene.published) throw UsageError("the baseline was not added");
  result.parts.push_back({published ? &*scene.published : &scene.tureen, &scene});
  return result;
}

/// The protocol uses one list of cameras, but each scene has its own. The names of the protocol's
/// cameras are indices into the scenes' lists.
BenchmarkCase benchmark_case_of(const BenchCase& bench_case) {
  return {.name = bench_case.name,
          .draw =
              [&bench_case](const FrameInput& input) {
                const std::size_t index = std::stoul(input.camera.name);
                for (const auto& [renderer, scene] : bench_case.parts)
                  renderer->draw({scene->cameras[index]});
              },
          .finish =
              [&bench_case] {
                for (const auto& [renderer, scene] : bench_case.parts) renderer->finish();
              }};
}

/// {"entrants", "rounds", "least_sample_ms"}
void begin(Engine& engine, const Json& arguments) {
  bench_of(engine).run.reset();
  bench_of(engine).cases.clear();
  std::size_t views = 0;
  for (const Json& benchmark_case : arguments.at("entrants")) {
    bench_of(engine).cases.push_back(bench_case_of(engine, benchmark_case));
    for (const auto& [renderer, scene] : bench_of(engine).cases.back().parts) {
      if (scene->cameras.empty()) throw UsageError("a scene has no cameras yet");
      if (views > 0 && scene->cameras.size() != views)
        throw UsageError("all scenes must have the same number of cameras");
      views = scene->cameras.size();
    }
  }
  if (bench_of(engine).cases.empty() || views == 0) throw UsageError("there is no case to measure");
  std::vector<Camera> numbers(views);
  for (std::size_t i = 0; i < views; ++i) numbers[i].name = std::to_string(i);
  std::vector<BenchmarkCase> cases;
  for (const BenchCase& bench_case : bench_of(engine).cases)
    cases.push_back(benchmark_case_of(bench_case));
  BenchmarkOptions options{.rounds = std::max(arguments.at("rounds").get<int>(), 1)};
  options.min_sample_ms = arguments.at("least_sample_ms");
  bench_of(engine).run.emplace(cases, numbers, options);
}

BenchmarkRun& run(Engine& engine) {
  if (!bench_of(engine).run) throw UsageError("no measurement is running");
  return *bench_of(engine).run;
}

/// Takes samples for `budget` milliseconds, at least one.
Json step(Engine& engine, const Json& budget) {
  const double end = milliseconds() + budget.get<double>();
  bool goes_on = run(engine).step();
  while (goes_on && milliseconds() < end) goes_on = run(engine).step();
  return object({{"done", !goes_on}, {"fraction", run(engine).fraction()}});
}

Json rounds_of(const FrameTimes& times) {
  Json rounds = Json::array();
  for (std::size_t i = 0; i < times.rounds(); ++i) {
    const auto round = times.round(i);
    rounds.push_back(std::vector<double>(round.begin(), round.end()));
  }
  return rounds;
}

Json to_json(const FrameStatistics& ms) {
  return object({{"mean", ms.mean},
                 {"median", ms.median},
                 {"p95", ms.p95},
                 {"p99", ms.p99},
                 {"min_of_medians", ms.min_of_medians},
                 {"spread", ms.spread},
                 {"low_1_percent_fps", ms.low_1_percent_fps}});
}

/// The hash of a frame's images, in their order.
std::string hash_of(const BenchCase& bench_case) {
  Image8 all;
  for (const auto& [renderer, scene] : bench_case.parts) {
    const Image8 one = renderer->read_color();
    all.pixels.insert(all.pixels.end(), one.pixels.begin(), one.pixels.end());
  }
  return pixels_hash(all);
}

Json result(Engine& engine, const Json&) {
  const BenchmarkResult measured = std::move(run(engine)).result();
  bench_of(engine).run.reset();
  Json self_test = Json::array(), cases = Json::array();
  for (const FrameTimes& times : measured.self_test) self_test.push_back(rounds_of(times));
  for (std::size_t i = 0; i < measured.cases.size(); ++i) {
    const CaseResult& benchmark_case = measured.cases[i];
    cases.push_back(object({{"name", benchmark_case.name},
                            {"stable", benchmark_case.stable},
                            {"frame_ms", rounds_of(benchmark_case.times)},
                            {"pixels_hash", hash_of(bench_of(engine).cases[i])},
                            {"statistics", to_json(statistics_of(benchmark_case.times))}}));
  }
  return object({{"frames_per_sample", measured.frames_per_sample},
                 {"aa_spread", measured.aa_spread},
                 {"self_test_ms", self_test},
                 {"entrants", cases}});
}

/// {"cells": [{"scene", "camera", "x", "y", "width", "height"}], "width", "height"}
void show(Engine& engine, const Json& arguments) {
  engine.page().clear_canvas(arguments.at("width"), arguments.at("height"));
  for (const Json& cell : arguments.at("cells")) {
    BenchScene& scene = scene_at(engine, cell.at("scene"));
    Renderer& renderer = scene.tureen;
    const auto& cameras = scene.cameras;
    if (cameras.empty()) continue;
    const Camera& camera = cameras[cell.at("camera").get<std::size_t>() % cameras.size()];
    renderer.draw({resized(camera, cell.at("width"), cell.at("height"))});
    renderer.blit_to(0, {cell.at("x").get<int>(), cell.at("y").get<int>()});
  }
}

}  // namespace

Commands bench_commands() {
  return {{"bench_clear", does(clear)},
          {"bench_add_scene", add_scene},
          {"bench_add_published", add_published},
          {"bench_cameras", does(set_cameras)},
          {"bench_run", does(begin)},
          {"bench_step", step},
          {"bench_result", result},
          {"bench_show", does(show)}};
}

}  // namespace tureen::web
