// The gain of each specialisation. A scene with its trait is drawn with the full plan and with the
// plan without this specialisation, frame by frame in turns; also real scenes, for all
// specialisations in their plans. Prints one row of JSON per line. Only the ratios apply to other
// machines. Software OpenGL is timed by the processor time of all its threads, which other programs
// hardly change.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "camera/navigation.hpp"
#include "formats/scene_file.hpp"
#include "jobs/timing/benchmark.hpp"
#include "runtime/renderer.hpp"
#include "tests/bench/run_program.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/trait_soups.hpp"

namespace tureen::test {
namespace {

struct Settings {
  int rounds = 5;  // each with eight views
  int width = 1280, height = 720;
  std::vector<std::filesystem::path> scenes;
};

/// Compares the frames of two plans that alternate view by view. A disturbance affects both frames
/// of a pair, so pairs resolve smaller differences than the medians of rounds.
nlohmann::json compared(const FrameTimes& with, const FrameTimes& without) {
  std::vector<double> ratios;
  std::size_t slower = 0;
  for (std::size_t i = 0; i < with.ms.size(); ++i) {
    ratios.push_back(without.ms[i] / with.ms[i]);
    slower += ratios.back() > 1 ? 1 : 0;
  }
  // The sign test: of n pairs with only random differences, half are slower, within 2.58 sqrt(n) /
  // 2 with a probability of 99 %.
  const double n = double(ratios.size());
  const bool significant = std::abs(double(slower) - 0.5 * n) > 1.29 * std::sqrt(n);
  return {{"with_ms", statistics_of(with).median},
          {"without_ms", statistics_of(without).median},
          {"gain", percentile(ratios, 50)},
          {"slower", slower},
          {"pairs", ratios.size()},
          {"significant", significant}};
}

/// Prints the ratio of frame times without and with the specialisation. `without` is the plan
/// without it.
void compare(const gl::Context& context, const Settings& settings, const char* what,
             const std::string& scene, const TriangleSoup& soup, std::span<const Camera> cameras,
             const PlanPreferences& without) {
  Renderer fast = renderer_of(context, soup, glm::dvec3(0.0));
  Renderer slow = renderer_of(context, soup, glm::dvec3(0.0), {.plan = without});
  const auto benchmark_case = [](const char* name, Renderer& renderer) {
    return BenchmarkCase{name, [&renderer](const FrameInput& input) { renderer.draw(input); },
                         [&renderer] { renderer.finish(); }};
  };
  const BenchmarkCase cases[] = {benchmark_case("with", fast), benchmark_case("without", slow)};
  BenchmarkOptions options{.rounds = settings.rounds};
  if (context.capabilities().software) options.clock = processor_seconds;
  const BenchmarkResult result = run_benchmark(cases, cameras, options);
  nlohmann::json row = compared(result.cases[0].times, result.cases[1].times);
  row["specialisation"] = what;
  row["scene"] = scene;
  row["with_mib"] = double(fast.device_bytes()) / (1 << 20);
  row["without_mib"] = double(slow.device_bytes()) / (1 << 20);
  std::printf("%s\n", row.dump().c_str());
  std::fflush(stdout);
}

bool is_of_the_network(Specialisation what) {
  switch (what) {
    case Specialisation::color_mlp:
    case Specialisation::view_direction:
    case Specialisation::weight_uniforms:
    case Specialisation::dead_neurons:
    case Specialisation::latent_features:
      return true;
    default:
      return false;
  }
}

/// A large scene with the trait. Lattices come from the cut-out cloud; the others are small random
/// triangles.
TriangleSoup large_soup(Specialisation what, const Scene& cloud) {
  const Kind kind = kind_of_trait(what);
  TriangleSoup soup;
  if (kind == Kind::lattice_mlp || kind == Kind::lattice) {
    soup = only_soup(cloud);
    if (kind == Kind::lattice) std::get<LatticeTexture>(soup.appearance).mlp.reset();
  } else {
    // Several pixels large; a tenth of that for small triangles, once they are split.
    const double size = what == Specialisation::small_triangles ? 0.005 : 0.02;
    soup = random_soup(1, {.kind = kind, .faces = 200000, .size = size, .degree = 3});
  }
  give_trait(what, soup);
  return soup;
}

void measure_traits(const gl::Context& context, const Settings& settings) {
  const Scene cloud = cutout_cloud({.width = settings.width, .height = settings.height});
  // The network's cost is measured best where it runs for every pixel and little else is done.
  const Scene wall = cutout_cloud({.triangles = 1500,
                                   .level = 2,
                                   .coverage = CloudCoverage::all,
                                   .width = settings.width,
                                   .height = settings.height});
  for (const SpecialisationName& row : specialisations_of_soups()) {
    const Scene& base = is_of_the_network(row.what) ? wall : cloud;
    compare(context, settings, row.name, "made for it", large_soup(row.what, base), base.cameras,
            {.specialisations = SpecialisationSet::all().without(row.what)});
  }
}

void measure_scene(const gl::Context& context, const Settings& settings,
                   const std::filesystem::path& path) {
  Scene scene = read_scene(path);
  make_opaque(scene);
  const TriangleSoup& soup = only_soup(scene);
  const Bounds box = bounds(soup);
  std::vector<Camera> cameras;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::acos(-1.0) / 4;
    const glm::dvec3 up(scene.info.up),
        side = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(up, side)), b = glm::cross(up, a);
    const glm::dvec3 away = std::cos(angle) * a + std::sin(angle) * b + 0.4 * up;
    cameras.push_back(look_at(box.center() + 2.2 * box.radius() * glm::normalize(away),
                              box.center(), up, 0.7, settings.width, settings.height));
  }
  const std::string name = path.stem().string();
  const RenderPlan plan = make_plan(soup, device_limits(context.capabilities()));
  for (const SpecialisationName& row : specialisations_of_soups())
    if (plan.applies(row.what))
      compare(context, settings, row.name, name, soup, cameras,
              {.specialisations = SpecialisationSet::all().without(row.what)});
  compare(context, settings, "all of them", name, soup, cameras, {.specialise = false});
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app("Measures the gain of each specialisation.");
  app.add_option("scenes", settings.scenes, "real scenes to measure, too");
  app.add_option("--rounds", settings.rounds, "number of rounds over the eight views")
      ->check(CLI::PositiveNumber);
  app.add_option("--width", settings.width)->check(CLI::PositiveNumber);
  app.add_option("--height", settings.height)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const gl::Context context = gl::Context::create({});
  measure_traits(context, settings);
  for (const auto& path : settings.scenes) measure_scene(context, settings, path);
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("specialisation_benchmark", tureen::test::run, argc, argv);
}
