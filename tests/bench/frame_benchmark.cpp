// Frame times of our plan against the published pipeline and against our own pipeline with nothing
// left out, on the cut-out cloud. The three are interleaved frame by frame, so that whatever else
// the machine does hits them alike; only the ratios mean anything on another machine.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/renderer.hpp"
#include "support/contexts.hpp"
#include "support/cutout_cloud.hpp"

namespace tureen::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Contender {
  const char* name;
  Renderer renderer;
  std::vector<double> milliseconds;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The same list against itself: how far the medians of two interleaved halves are apart.
double spread(const std::vector<double>& values) {
  std::vector<double> even, odd;
  for (std::size_t i = 0; i < values.size(); ++i) (i % 2 ? odd : even).push_back(values[i]);
  return std::abs(median(even) - median(odd)) / median(values);
}

double timed_frame(Renderer& renderer, const Camera& camera) {
  renderer.finish();
  const auto start = Clock::now();
  renderer.draw(camera);
  renderer.finish();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void measure(const gl::Context& context, CloudCoverage coverage, int rounds, int width,
             int height) {
  const Scene scene = cutout_cloud({.coverage = coverage, .width = width, .height = height});
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  const auto contender = [&](const char* name, PlanPreferences plan) {
    return Contender{name, Renderer(context, soup, scene.origin, {.plan = plan}), {}};
  };
  Contender contenders[] = {contender("published", {.pipeline = PipelineKind::published}),
                            contender("nothing left out", {.specialise = false}),
                            contender("our plan", {})};

  contenders[2].renderer.draw(scene.cameras[0]);
  const auto faces = contenders[2].renderer.read_faces();
  const double covered =
      double(faces.size() - std::size_t(std::count(faces.begin(), faces.end(), no_face))) /
      double(faces.size());

  for (Contender& c : contenders)  // warm-up: shader compilation, first touches
    for (int i = 0; i < 3; ++i) timed_frame(c.renderer, scene.cameras[std::size_t(i)]);
  for (int round = 0; round < rounds; ++round)
    for (const Camera& camera : scene.cameras)
      for (Contender& c : contenders) c.milliseconds.push_back(timed_frame(c.renderer, camera));

  for (const Contender& c : contenders)
    std::printf("| %3.0f %% | %-16s | %6.1f | %5.1f %% | %5.2f |\n", 100 * covered, c.name,
                median(c.milliseconds), 100 * spread(c.milliseconds),
                median(contenders[0].milliseconds) / median(c.milliseconds));
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  using namespace tureen;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  const int width = argc > 3 ? std::atoi(argv[2]) : 1280;
  const int height = argc > 3 ? std::atoi(argv[3]) : 720;
  if (rounds < 1 || width < 1 || height < 1) {
    std::fprintf(stderr, "usage: frame_benchmark [ROUNDS [WIDTH HEIGHT]]   (5 1280 720)\n");
    return 2;
  }
  const gl::Context context = gl::Context::create({});
  std::printf("%s, %s; 15,000 cut-out triangles, level 5, %d x %d, %d frames each\n\n",
              context.description().c_str(), context.capabilities().renderer.c_str(), width, height,
              8 * rounds);
  std::printf("| covered | pipeline | median ms | A/A spread | times as fast as published |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const auto coverage :
       {test::CloudCoverage::third, test::CloudCoverage::forty_percent, test::CloudCoverage::all})
    test::measure(context, coverage, rounds, width, height);
}
