// Frame times of a large opaque soup, the whole scene in the frame: our plan against a renderer as
// plain as they come, in turns. Only the ratio means anything on another machine.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>

#include "bench/dense_soup.hpp"
#include "bench/plain_renderer.hpp"
#include "formats/scene_file.hpp"
#include "runtime/benchmark.hpp"
#include "runtime/renderer.hpp"
#include "soup/error.hpp"

namespace tureen::testing {
namespace {

/// Eight views from all around, 20 degrees above the middle, that show the whole bounding sphere.
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
    const double angle = 0.785398163397448 * i;
    const glm::dvec3 direction =
        0.94 * (std::cos(angle) * side + std::sin(angle) * front) + 0.34 * up;
    cameras.push_back(look_at(box.centre() + distance * direction, box.centre(), up, field_of_view,
                              width, height));
  }
  return cameras;
}

/// Seconds of processor time of all threads: what a busy machine leaves meaningful, with
/// LP_NUM_THREADS=0.
double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

struct Options {
  std::size_t triangles = 2000000;
  int rounds = 3, width = 1280, height = 720;
  bool processor_time = false;
};

void measure(const Scene& base, const Options& options) {
  const auto& [triangles, rounds, width, height, processor_time] = options;
  const TriangleSoup soup = dense_soup(std::get<TriangleSoup>(base.primitives), triangles);
  gl::Context context = gl::Context::create({});
  PlainRenderer plain(soup);
  Renderer whole(context, soup, glm::dvec3(0), {.plan = {.specialise = false}});
  Renderer ours(context, soup, glm::dvec3(0));
  const auto finish = [] { glFinish(); };
  const std::vector<Entrant> entrants = {
      {"plain", [&](const Camera& camera) { plain.draw(camera); }, finish},
      {"nothing left out", [&](const Camera& camera) { whole.draw(camera); }, finish},
      {"our plan", [&](const Camera& camera) { ours.draw(camera); }, finish}};
  const auto cameras = views_around(soup, base.info.up, width, height);
  const BenchmarkResult result =
      run_benchmark(entrants, cameras,
                    {.rounds = rounds,
                     .self_test = processor_time ? BenchmarkOptions::SelfTest::leave_out
                                                 : BenchmarkOptions::SelfTest::run,
                     .clock = processor_time ? processor_seconds : std::function<double()>()});
  std::printf("%s; %zu triangles, %d x %d, %d rounds of %zu views, A/A spread %.1f %%\n\n",
              context.capabilities().renderer.c_str(), soup.triangles.size(), width, height,
              result.rounds, cameras.size(), 100 * result.aa_spread);
  for (const std::string& sentence : ours.plan().sentences) std::printf("- %s\n", sentence.c_str());
  std::printf("\n| renderer | ms | times as fast as plain |\n|---|---|---|\n");
  const double baseline = statistics_of(result.entrants[0].times).min_of_medians;
  for (const EntrantResult& entrant : result.entrants) {
    const double ms = statistics_of(entrant.times).min_of_medians;
    std::printf("| %s | %.1f | %.2f |\n", entrant.name.c_str(), ms, baseline / ms);
  }
}

}  // namespace
}  // namespace tureen::testing

int main(int argc, char** argv) {
  CLI::App app("Times a large opaque soup, made of BASE by splitting its triangles");
  std::string base;
  tureen::testing::Options options;
  app.add_option("BASE", base, "any small soup")->required();
  app.add_option("--triangles", options.triangles, "at least this many");
  app.add_option("--rounds", options.rounds, "of eight views each")->check(CLI::PositiveNumber);
  app.add_option("--width", options.width)->check(CLI::PositiveNumber);
  app.add_option("--height", options.height)->check(CLI::PositiveNumber);
  app.add_flag("--processor-time", options.processor_time,
               "processor time instead of wall time (with LP_NUM_THREADS=0, on a busy machine)");
  CLI11_PARSE(app, argc, argv);
  try {
    tureen::testing::measure(tureen::read_scene(base), options);
  } catch (const tureen::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
