// Frame times of a large opaque soup, the whole scene in the frame: our plan against a renderer as
// plain as they come, in turns. Only the ratio means anything on another machine.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "bench/dense_soup.hpp"
#include "bench/plain_renderer.hpp"
#include "cli/bench_words.hpp"
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

std::size_t differing_pixels(const Image8& a, const Image8& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels[i] ? 1 : 0;
  return count;
}

const char* difference_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::unknown:
      return "too few rounds to know";
    case Verdict::equal:
      return "no";
    case Verdict::faster:
    case Verdict::slower:
      return "yes";
  }
  return "";
}

struct Options {
  std::size_t triangles = 2000000;
  // 10 rounds of 8 views and 6 turns (four renderers, and the first against itself) are 480 frames:
  // 70 s where they take 0.15 s each.
  int rounds = 10, width = 1280, height = 720;
  bool processor_time = false;
};

void measure(const Scene& base, const Options& options) {
  const auto& [triangles, rounds, width, height, processor_time] = options;
  const TriangleSoup soup = dense_soup(std::get<TriangleSoup>(base.primitives), triangles);
  const gl::Context context = gl::Context::create({});
  if (processor_time && !context.capabilities().software)
    throw UsageError("--processor-time says nothing of " + context.capabilities().renderer);
  PlainRenderer plain(soup);
  const glm::vec4 black(0, 0, 0, 1);
  Renderer whole(context, soup, glm::dvec3(0),
                 {.plan = {.specialise = false}, .background = black});
  const LeaveOutSet all_but = LeaveOutSet::all().without(LeaveOut::faces_between_pixels);
  Renderer with_tiny(context, soup, glm::dvec3(0),
                     {.plan = {.leave_out = all_but}, .background = black});
  Renderer ours(context, soup, glm::dvec3(0), {.background = black});
  const auto finish = [] { glFinish(); };
  const std::vector<Entrant> entrants = {
      {"plain", [&](const Camera& camera) { plain.draw(camera); }, finish},
      {"nothing left out", [&](const Camera& camera) { whole.draw(camera); }, finish},
      {"our plan with faces between pixels", [&](const Camera& camera) { with_tiny.draw(camera); },
       finish},
      {"our plan", [&](const Camera& camera) { ours.draw(camera); }, finish}};
  const auto cameras = views_around(soup, base.info.up, width, height);
  const BenchmarkResult result = run_benchmark(
      entrants, cameras, {.rounds = rounds, .clock = processor_time ? processor_seconds : nullptr});
  std::printf("%s, %s; %zu triangles, %d x %d, %d rounds of %zu views, A/A spread %.1f %%\n\n",
              context.capabilities().renderer.c_str(),
              processor_time ? "processor time of all threads" : "time that passed",
              soup.triangles.size(), width, height, result.rounds, cameras.size(),
              100 * result.aa_spread);
  for (const std::string& sentence : ours.plan().sentences) std::printf("- %s\n", sentence.c_str());
  std::printf("- %zu of %d pixels of the last view differ from the plain renderer's\n",
              differing_pixels(plain.read_color(), ours.read_color()), width * height);
  std::printf(
      "\n| renderer | ms | spread | times as fast as plain | by more than twice the spread |\n"
      "|---|---|---|---|---|\n");
  const FrameStatistics baseline = statistics_of(result.entrants[0].times);
  for (const EntrantResult& entrant : result.entrants) {
    const FrameStatistics statistics = statistics_of(entrant.times);
    std::printf("| %s%s | %.1f | %s | %.2f | %s |\n", entrant.name.c_str(),
                entrant.stable ? "" : cli::restless_mark, statistics.min_of_medians,
                cli::spread_text(statistics).c_str(),
                baseline.min_of_medians / statistics.min_of_medians,
                &entrant == &result.entrants[0]
                    ? ""
                    : difference_text(verdict_on(statistics, baseline, result.aa_spread)));
  }
  if (std::any_of(result.entrants.begin(), result.entrants.end(),
                  [](const EntrantResult& entrant) { return !entrant.stable; }))
    std::printf("\n%s\n", cli::restless_sentence);
}

}  // namespace
}  // namespace tureen::testing

int main(int argc, char** argv) {
  try {
    CLI::App app("Times a large opaque soup, made of BASE by splitting its triangles");
    std::string base;
    tureen::testing::Options options;
    app.add_option("BASE", base, "any small soup")->required();
    app.add_option("--triangles", options.triangles, "at least this many");
    app.add_option("--rounds", options.rounds, "of eight views each")->check(CLI::PositiveNumber);
    app.add_option("--width", options.width)->check(CLI::PositiveNumber);
    app.add_option("--height", options.height)->check(CLI::PositiveNumber);
    app.add_flag("--processor-time", options.processor_time,
                 "of all threads, instead of time that passed: for a busy machine; software only");
    CLI11_PARSE(app, argc, argv);
    tureen::testing::measure(tureen::read_scene(base), options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
