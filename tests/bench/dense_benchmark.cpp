// Frame times of an opaque soup with a colour per face, with the whole scene in view. Our plan, the
// plan without small-triangle culling and the generic plan are compared with a minimal renderer, in
// turns. Prints one row of JSON per renderer. Only the ratios apply to other machines.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/scene_file.hpp"
#include "jobs/timing/benchmark.hpp"
#include "runtime/renderer.hpp"
#include "tests/bench/plain_renderer.hpp"
#include "tests/bench/run_program.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {
namespace {

/// Eight views around the soup, 20 degrees above the middle, that show the whole bounding sphere.
std::vector<Camera> views_around(const TriangleSoup& soup, glm::dvec3 up, int width, int height) {
  const Bounds box = bounds(soup);
  const double field_of_view = 0.7;
  const double distance = 1.05 * box.radius() / std::sin(0.5 * field_of_view);
  up = glm::normalize(up);
  const glm::dvec3 side = glm::normalize(
      glm::cross(up, std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 front = glm::cross(up, side);
  std::vector<Camera> cameras;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::acos(-1.0) / 4;
    const glm::dvec3 direction =
        0.94 * (std::cos(angle) * side + std::sin(angle) * front) + 0.34 * up;
    cameras.push_back(look_at(box.center() + distance * direction, box.center(), up, field_of_view,
                              width, height));
  }
  return cameras;
}

int run(int argc, char** argv) {
  CLI::App app("Times an opaque soup against a plain renderer.");
  std::string path;
  // 10 rounds with 8 views and 5 turns (four renderers, and the first a second time) are 400
  // frames: 60 s at 0.15 s per frame.
  int rounds = 10, width = 1280, height = 720;
  bool processor_time = false;
  app.add_option("SOUP", path)->required();
  app.add_option("--rounds", rounds, "of eight views each")->check(CLI::PositiveNumber);
  app.add_option("--width", width)->check(CLI::PositiveNumber);
  app.add_option("--height", height)->check(CLI::PositiveNumber);
  app.add_flag("--processor-time", processor_time, "of all threads; software OpenGL only");
  CLI11_PARSE(app, argc, argv);

  Scene scene = read_scene(path);
  make_opaque(scene);
  const TriangleSoup& soup = only_soup(scene);
  const gl::Context context = gl::Context::create({});
  const glm::vec4 black(0, 0, 0, 1);
  const auto with_plan = [&](const PlanPreferences& plan) {
    return renderer_of(context, soup, glm::dvec3(0), {.plan = plan, .background = black});
  };
  PlainRenderer plain(soup);
  Renderer ours = with_plan({}), generic = with_plan({.specialise = false});
  Renderer with_small = with_plan(
      {.specialisations = SpecialisationSet::all().without(Specialisation::small_triangles)});
  const auto finish = [] { glFinish(); };
  const BenchmarkCase cases[] = {
      {"plain", [&](const FrameInput& input) { plain.draw(input.camera); }, finish},
      {"generic", [&](const FrameInput& input) { generic.draw(input); }, finish},
      {"no small-triangle culling", [&](const FrameInput& input) { with_small.draw(input); },
       finish},
      {"tureen", [&](const FrameInput& input) { ours.draw(input); }, finish}};
  const BenchmarkResult result =
      run_benchmark(cases, views_around(soup, scene.info.up, width, height),
                    {.rounds = rounds, .clock = processor_time ? processor_seconds : nullptr});
  const FrameStatistics baseline = statistics_of(result.cases[0].times);
  for (const CaseResult& benchmark_case : result.cases) {
    const FrameStatistics statistics = statistics_of(benchmark_case.times);
    const nlohmann::json row = {{"renderer", benchmark_case.name},
                                {"triangles", soup.triangles.size()},
                                {"ms", statistics.min_of_medians},
                                {"spread", statistics.spread},
                                {"aa_spread", result.aa_spread},
                                {"ratio", baseline.min_of_medians / statistics.min_of_medians}};
    std::printf("%s\n", row.dump().c_str());
  }
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("dense_benchmark", tureen::test::run, argc, argv);
}
